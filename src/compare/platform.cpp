#include "compare/platform.h"

#include <fstream>
#include <iterator>

namespace tumble {

std::string platform_of(std::string_view cpuinfo) {
    if (cpuinfo.find("AuthenticAMD") != std::string_view::npos) return "amd";
    if (cpuinfo.find("GenuineIntel") != std::string_view::npos) return "intel";
    if (cpuinfo.find("CPU implementer") != std::string_view::npos) return "arm";
    return "other";
}

std::string this_platform() {
    std::ifstream stream("/proc/cpuinfo");
    const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    return platform_of(text);
}

bool is_platform_name(std::string_view name) {
    return !name.empty() && name.front() != '.' && name.find('/') == std::string_view::npos;
}

std::string platform_of_option(const std::optional<std::string>& name) {
    if (name == "none") return "";
    return name ? *name : this_platform();
}

std::vector<std::string> platform_folders(const std::vector<std::string>& more) {
    std::vector<std::string> folders{"amd", "intel", "arm", "other"};
    folders.insert(folders.end(), more.begin(), more.end());
    return folders;
}

}  // namespace tumble
