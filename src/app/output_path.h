// Where a result must not go.
#pragma once

#include <filesystem>

namespace tumble {

/// Do both name one file that is there? However they are spelt; devices and pipes do not count.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Throws InputError where the output that `option` names would replace the input.
void check_output(const char* option, const std::filesystem::path& output, const std::filesystem::path& input);

}  // namespace tumble
