// References for a kind of processor: pixels differ between processors in few places.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The name of this machine's processor: "amd", "intel", "arm" or "other".
std::string this_platform();

/// True for the name of a folder that a comparison reads: no path, and not hidden.
bool is_platform_name(std::string_view name);

/// Option --platform: that of its name, of this machine without the option, and empty (no platform) for "none".
std::string platform_of_option(const std::optional<std::string>& name);

/// Folders of references with these names hold those of a platform: those of this_platform(), and `more`.
std::vector<std::string> platform_folders(const std::vector<std::string>& more);

/// The same from the text of /proc/cpuinfo.
std::string platform_of(std::string_view cpuinfo);

}  // namespace tumble
