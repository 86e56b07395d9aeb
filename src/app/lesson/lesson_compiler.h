// The compiler of lessons (web/lesson), a program in Node.js.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

/// Runs lesson.cjs of the web folder with this input and returns its output. Throws RunError if Node.js is missing or
/// fails.
std::string run_lesson_compiler(const std::filesystem::path& web_folder, const std::vector<std::string>& arguments,
                                const std::string& input);

}  // namespace tumble
