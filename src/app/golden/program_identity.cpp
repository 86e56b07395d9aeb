#include "app/golden/image_cache.h"

#include "app/golden/child_tasks.h"
#include "core/error.h"
#include "core/sha256.h"
#include "render/gl/shader_source.h"

#include <fmt/format.h>

#include <dlfcn.h>
#include <link.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <system_error>
#include <vector>

namespace tumble {
namespace {

namespace fs = std::filesystem;

// Libraries that the drawing opens at run time: the software renderer, EGL with its driver, and Pango with Cairo.
constexpr std::array drawing_libraries = {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so", "libEGL.so.1",
                                          "libpangocairo-1.0.so.0"};
// Mesa and LLVM read them, and pixels may depend on them.
constexpr std::array driver_variables = {"GALLIUM_DRIVER",
                                         "LP_NATIVE_VECTOR_WIDTH",
                                         "LP_NUM_THREADS",
                                         "LP_PERF",
                                         "MESA_LOADER_DRIVER_OVERRIDE",
                                         "GALLIUM_OVERRIDE_CPU_CAPS",
                                         "LIBGL_ALWAYS_SOFTWARE",
                                         "GLIBC_TUNABLES",
                                         "FONTCONFIG_FILE",
                                         "FONTCONFIG_PATH"};

void add_content(const fs::path& file, Sha256& hash) {
    std::ifstream stream(file, std::ios::binary);
    std::vector<char> block(1 << 16);
    while (stream.read(block.data(), std::streamsize(block.size())), stream.gcount() > 0)
        hash.add(std::as_bytes(std::span(block)).first(std::size_t(stream.gcount())));
}

/// Name, size and time of change: enough to see that a package was updated.
std::string stamp_of(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return file.string();
    return fmt::format("{} {} {}", file.string(), status.st_size, status.st_mtim.tv_sec);
}

int add_library(dl_phdr_info* info, std::size_t, void* list) {
    if (info->dlpi_name != nullptr && *info->dlpi_name == '/')
        static_cast<std::vector<std::string>*>(list)->push_back(stamp_of(info->dlpi_name));
    return 0;
}

/// All libraries of the process, once the drawing's libraries are loaded.
std::string loaded_libraries() {
    for (const char* name : drawing_libraries) ::dlopen(name, RTLD_LAZY | RTLD_LOCAL);
    std::vector<std::string> libraries;
    ::dl_iterate_phdr(add_library, &libraries);
    std::ranges::sort(libraries);
    std::string text;
    for (const std::string& library : libraries) text += library + "\n";
    return text;
}

std::string content_hash(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
        if (it->is_regular_file(error)) files.push_back(it->path());
    std::ranges::sort(files);
    Sha256 hash;
    for (const fs::path& file : files) {
        hash.add(file.filename().string());
        add_content(file, hash);
    }
    return hash.finish();
}

/// The files of fonts and of their configuration.
std::string fonts() {
    std::vector<fs::path> roots = {"/usr/share/fonts", "/usr/local/share/fonts", "/etc/fonts"};
    if (const char* home = std::getenv("HOME"))
        for (const char* folder : {".fonts", ".local/share/fonts", ".config/fontconfig"})
            roots.push_back(fs::path(home) / folder);
    std::vector<std::string> stamps;
    std::error_code error;
    for (const fs::path& root : roots)
        for (fs::recursive_directory_iterator it(root, error), end; !error && it != end; it.increment(error))
            if (it->is_regular_file(error)) stamps.push_back(stamp_of(it->path()));
    std::ranges::sort(stamps);
    std::string text;
    for (const std::string& stamp : stamps) text += stamp + "\n";
    return text;
}

/// The kind of the first processor and its instruction sets.
std::string processor() {
    std::ifstream file("/proc/cpuinfo");
    std::string text;
    for (std::string line; std::getline(file, line) && !line.empty();)
        if (line.starts_with("model name") || line.starts_with("flags")) text += line + "\n";
    return text;
}

}  // namespace

std::string program_identity(Interrupt& interrupt) {
    std::error_code error;
    Sha256 program;
    add_content("/proc/self/exe", program);
    std::string text = fmt::format("program {}\nshaders {}\n", program.finish(), content_hash(find_shader_folder()));
    run_in_children(
        1, 1, [](std::size_t) { return loaded_libraries(); },
        [&](std::size_t, const TaskEnd& end) { text += end.text; }, interrupt);
    for (const char* name : driver_variables)
        if (const char* value = std::getenv(name)) text += fmt::format("{}={}\n", name, value);
    return text + fonts() + processor();
}

}  // namespace tumble
