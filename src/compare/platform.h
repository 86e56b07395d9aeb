// References for a kind of processor: pixels differ between processors in few places.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// Folders of references with these names hold those of a platform.
inline constexpr std::string_view known_platforms[] = {"amd", "intel", "arm", "other"};

/// The name of this machine's processor: one of known_platforms.
std::string this_platform();

/// The same from the text of /proc/cpuinfo.
std::string platform_of(std::string_view cpuinfo);

}  // namespace tumble
