#include "api/record_table.h"

#include "output/npz_archive.h"
#include "output/temporary_file.h"

#include <algorithm>
#include <limits>

namespace tumble::v0 {

RecordTable::RecordTable(const std::string& file, std::string_view header) : file_(file) {
    if (!file.ends_with(".npz")) {
        csv_.emplace(file, header);
        return;
    }
    for (std::size_t first = 0; first <= header.size();) {
        const std::size_t end = std::min(header.find(',', first), header.size());
        columns_.push_back({std::string(header.substr(first, end - first)), {}, {}, {}, {}});
        first = end + 1;
    }
}

RecordTable& RecordTable::integer(std::int64_t value) {
    if (csv_)
        csv_->integer(value);
    else
        next().integers.push_back(std::int32_t(value));
    return *this;
}

RecordTable& RecordTable::number(double value) {
    if (csv_)
        csv_->number(value);
    else
        next().numbers.push_back(value);
    return *this;
}

RecordTable& RecordTable::no_number() {
    if (csv_)
        csv_->text("");
    else
        next().numbers.push_back(std::numeric_limits<double>::quiet_NaN());
    return *this;
}

RecordTable& RecordTable::text(std::string_view value) {
    if (csv_) {
        csv_->text(value);
        return *this;
    }
    Column& column = next();
    const auto [at, is_new] = column.indices.emplace(value, std::int32_t(column.texts.size()));
    if (is_new) column.texts.emplace_back(value);
    column.integers.push_back(at->second);
    return *this;
}

void RecordTable::end_row() {
    if (csv_) csv_->end_row();
    column_ = 0;
}

void RecordTable::finish() {
    if (csv_)
        csv_->finish();
    else
        write_arrays();
}

void RecordTable::write_arrays() {
    NpzArchive archive;
    for (const Column& column : columns_) {
        if (!column.numbers.empty())
            archive.add(column.name, {column.numbers.size()}, column.numbers);
        else
            archive.add(column.name, {column.integers.size()}, column.integers);
        if (column.texts.empty()) continue;
        std::size_t length = 1;
        for (const std::string& text : column.texts) length = std::max(length, text.size());
        std::vector<std::uint8_t> bytes(length * column.texts.size());
        for (std::size_t k = 0; k < column.texts.size(); ++k)
            std::copy(column.texts[k].begin(), column.texts[k].end(), bytes.begin() + std::ptrdiff_t(k * length));
        archive.add(column.name + "_names", {column.texts.size(), length}, bytes);
    }
    write_file(file_, archive.finish());
}

}  // namespace tumble::v0
