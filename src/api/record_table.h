// A table of records as CSV, row by row, or as an .npz file with an array for each column (by the file's ending).
#pragma once

#include "output/table_writer.h"
#include "tumble/vector.h"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tumble::v0 {

/// In an .npz file numbers are float64, whole numbers int32, and text an index into the array COLUMN_names, whose texts
/// are zero-padded bytes. Such a file is kept in memory until finish().
class RecordTable {
public:
    /// `header`: the columns, separated by commas. All members throw RunError if the file cannot be written.
    RecordTable(const std::string& file, std::string_view header);

    RecordTable& integer(std::int64_t value);
    RecordTable& number(double value);
    /// A number that does not exist: empty in CSV, NaN in an .npz file.
    RecordTable& no_number();
    RecordTable& text(std::string_view value);
    RecordTable& vector(const Vec3& v) { return number(v.x).number(v.y).number(v.z); }
    void end_row();

    void finish();

private:
    struct Column {
        std::string name;
        std::vector<double> numbers;
        std::vector<std::int32_t> integers;
        std::map<std::string, std::int32_t> indices;  // of texts
        std::vector<std::string> texts;
    };
    Column& next() { return columns_[column_++]; }
    void write_arrays();

    std::string file_;
    std::optional<TableWriter> csv_;
    std::vector<Column> columns_;  // of an .npz file
    std::size_t column_ = 0;
};

}  // namespace tumble::v0
