// Tables of numbers as CSV files, written row by row, so that memory does not grow with their length.
#pragma once

#include "output/temporary_file.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace tumble {

/// Numbers have 17 significant digits, which restores every double to the bit; the decimal sign is a point in every
/// locale. Text with a comma, a quote or a line break is quoted (RFC 4180). The file appears under its name at
/// finish(), or never.
class TableWriter {
public:
    /// `header`: the first row, verbatim. All members throw RunError if the file cannot be written.
    TableWriter(const std::filesystem::path& path, std::string_view header);

    TableWriter& integer(std::int64_t value);
    TableWriter& number(double value);
    TableWriter& text(std::string_view value);
    void end_row();

    void finish();

private:
    void separate();
    void flush();

    TemporaryFile file_;
    fmt::memory_buffer buffer_;
    bool first_in_row_ = true;
};

}  // namespace tumble
