// Tables of numbers as CSV files, written row by row: memory stays flat however long they grow.
#pragma once

#include "output/temporary_file.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace tumble {

/// Numbers keep 17 significant digits, which brings every double back to the bit; a point is the decimal sign in any
/// locale. Text with a comma, a quote or a line break is quoted (RFC 4180). The file appears under its name at
/// finish(), or never.
class TableWriter {
public:
    /// `header` is the first row, as it is. Throws RunError where the file cannot be written; so do all below.
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
