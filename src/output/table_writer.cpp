#include "output/table_writer.h"

#include <iterator>

namespace tumble {
namespace {

constexpr std::size_t flush_at = 1 << 16;  // bytes: large enough that system calls cost little

}  // namespace

TableWriter::TableWriter(const std::filesystem::path& path, std::string_view header) : file_(path) {
    buffer_.append(header);
    end_row();
}

void TableWriter::separate() {
    if (!first_in_row_) buffer_.push_back(',');
    first_in_row_ = false;
}

TableWriter& TableWriter::integer(std::int64_t value) {
    separate();
    fmt::format_to(std::back_inserter(buffer_), "{}", value);
    return *this;
}

TableWriter& TableWriter::number(double value) {
    separate();
    fmt::format_to(std::back_inserter(buffer_), "{:.17g}", value);
    return *this;
}

TableWriter& TableWriter::text(std::string_view value) {
    separate();
    if (value.find_first_of(",\"\r\n") == std::string_view::npos) {
        buffer_.append(value);
        return *this;
    }
    buffer_.push_back('"');
    for (const char c : value) {
        if (c == '"') buffer_.push_back('"');
        buffer_.push_back(c);
    }
    buffer_.push_back('"');
    return *this;
}

void TableWriter::end_row() {
    buffer_.push_back('\n');
    first_in_row_ = true;
    if (buffer_.size() >= flush_at) flush();
}

void TableWriter::flush() {
    file_.write(std::as_bytes(std::span(buffer_.data(), buffer_.size())));
    buffer_.clear();
}

void TableWriter::finish() {
    flush();
    file_.commit();
}

}  // namespace tumble
