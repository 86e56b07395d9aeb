#include "scene/keys/posed_bodies.h"

#include "core/safe_text.h"
#include "scene/keys/bodies.h"
#include "scene/toml/error_text.h"
#include "scene/toml/limits.h"
#include "scene/toml/source_position.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

namespace tumble {
namespace {

constexpr Range quaternion_component{-1e6, 1e6, ""};  // far above a unit quaternion, with a finite square

struct Cell {
    std::string_view text;  // without the quotes around it
    bool quoted = false;
};

/// The lines of a CSV text, cell by cell. Cells in quotes may hold commas, and quotes as two.
class CsvLines {
public:
    CsvLines(std::string_view text, const std::string& file) : rest_(text), file_(file) {
        constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
        if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
    }

    /// Goes to the next line that is not empty; false at the end.
    bool next();
    const std::vector<Cell>& cells() const { return cells_; }
    /// Upper bound of the number of lines that follow.
    std::int64_t left() const { return 1 + std::ranges::count(rest_, '\n'); }

    SourcePosition at(const Cell& cell, std::string_view name) const {
        return {std::string(name), place(std::size_t(cell.text.data() - line_.data()) - cell.quoted)};
    }
    /// Fails at the start of the line.
    [[noreturn]] void fail(const std::string& problem) const { throw InputError(place(0), problem); }

private:
    SourceLocation place(std::size_t byte) const {  // columns count characters
        const auto starts_character = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };
        return {file_, number_, 1 + int(std::ranges::count_if(line_.substr(0, byte), starts_character))};
    }
    std::size_t add_quoted(std::size_t first);

    std::string_view rest_, line_;
    const std::string& file_;
    int number_ = 0;  // of the line, from 1
    std::vector<Cell> cells_;
};

bool CsvLines::next() {
    do {
        if (rest_.empty()) return false;
        const std::size_t end = rest_.find('\n');
        line_ = rest_.substr(0, end);
        rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
        ++number_;
        if (line_.ends_with('\r')) line_.remove_suffix(1);
    } while (line_.empty());
    cells_.clear();
    for (std::size_t i = 0;;) {
        std::size_t end;
        if (line_.substr(i).starts_with('"')) {
            end = add_quoted(i);
        } else {
            end = std::min(line_.find(',', i), line_.size());
            cells_.push_back({line_.substr(i, end - i)});
        }
        if (end == line_.size()) return true;
        i = end + 1;
    }
}

/// Returns the end of the cell.
std::size_t CsvLines::add_quoted(std::size_t first) {
    for (std::size_t i = first + 1; i < line_.size(); ++i) {
        if (line_[i] != '"') continue;
        if (line_.substr(i + 1).starts_with('"')) {
            ++i;
            continue;
        }
        if (i + 1 < line_.size() && line_[i + 1] != ',')
            throw InputError(place(i + 1), "a cell in quotes ends before a comma; write a quote within it twice");
        cells_.push_back({line_.substr(first + 1, i - first - 1), true});
        return i + 1;
    }
    throw InputError(place(first), "the quote at the start of this cell has no end in the line");
}

constexpr auto column_names = std::to_array<std::string_view>(
    {"body", "x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz"});
constexpr std::size_t absent = SIZE_MAX;

class PoseReader {
public:
    PoseReader(std::string_view text, const std::string& file, const BodyDescription& model)
        : lines_(text, file), file_(file), model_(model) {}

    PosedBodies read(BodyNames& names, std::int64_t before);

private:
    enum Column : std::size_t { body, x, y, z, qw, qx, qy, qz, vx, vy, vz, wx, wy, wz };  // of column_names
    void read_header();
    bool has_group(Column first, std::size_t count) const;
    void refuse_velocity(Column column) const;
    const Cell& cell(Column column) const { return lines_.cells()[places_[column]]; }
    SourcePosition at(Column column) const { return lines_.at(cell(column), column_names[column]); }
    double number(Column column, const Range& range) const;
    Vec3 vector(Column first, const Range& range) const {
        return {number(first, range), number(Column(first + 1), range), number(Column(first + 2), range)};
    }
    Quat rotation() const;
    std::string name() const;

    CsvLines lines_;
    const std::string& file_;
    const BodyDescription& model_;
    std::array<std::size_t, column_names.size()> places_{};  // in a line, by column
};

void PoseReader::read_header() {
    places_.fill(absent);
    if (!lines_.next()) throw InputError({file_, 1, 1}, "is empty: the first line names the columns, such as x,y,z");
    for (std::size_t i = 0; i < lines_.cells().size(); ++i) {
        const Cell& cell = lines_.cells()[i];
        const auto known = std::ranges::find(column_names, cell.text);
        if (known == column_names.end())
            throw InputError(lines_.at(cell, {}).where,
                             fmt::format("unknown column \"{}\"{}", safe_text(cell.text),
                                         suggestion(cell.text, {column_names.begin(), column_names.end()})));
        std::size_t& place = places_[std::size_t(known - column_names.begin())];
        if (place != absent) lines_.at(cell, cell.text).fail("is there twice");
        place = i;
    }
}

/// Columns that go together. Fails if some are missing.
bool PoseReader::has_group(Column first, std::size_t count) const {
    const auto places = std::span(places_).subspan(first, count);
    const auto missing = std::ranges::find(places, absent);
    if (missing == places.end()) return true;
    if (first != x && std::ranges::all_of(places, [](std::size_t place) { return place == absent; })) return false;
    const auto group = std::span(column_names).subspan(first, count);
    lines_.fail(fmt::format("has no column \"{}\": {} go together", group[std::size_t(missing - places.begin())],
                            fmt::join(group, ", ")));
}

void PoseReader::refuse_velocity(Column column) const {
    if (model_.type != BodyType::dynamic) at(column).fail("is for dynamic bodies: leave the column out");
}

double PoseReader::number(Column column, const Range& range) const {
    std::string_view text = cell(column).text;
    while (text.starts_with(' ')) text.remove_prefix(1);
    while (text.ends_with(' ')) text.remove_suffix(1);
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        at(column).fail(fmt::format("must be a number (given \"{}\")", safe_text(cell(column).text)));
    return range.contains(value) ? value : checked(value, range, at(column));
}

Quat PoseReader::rotation() const {
    const Vec3 v = vector(qx, quaternion_component);
    const Quat q(number(qw, quaternion_component), v.x(), v.y(), v.z());
    const double norm = q.norm();
    if (!(std::fabs(norm - 1.0) <= limits::quaternion_tolerance))
        at(qw).fail(fmt::format("must begin a quaternion of length 1 (given one of length {:.6g})", norm));
    return q.normalized();
}

std::string PoseReader::name() const {
    std::string name(cell(body).text);
    for (std::size_t i = 0; cell(body).quoted && (i = name.find("\"\"", i)) != std::string::npos; ++i) name.erase(i, 1);
    if (name.empty()) at(body).fail("must not be empty");
    if (safe_text(name, name.size() + 1) != name)
        at(body).fail(fmt::format("must be printable UTF-8 (given \"{}\")", safe_text(name)));
    return name;
}

PosedBodies PoseReader::read(BodyNames& names, std::int64_t before) {
    read_header();
    has_group(x, 3);
    PosedBodies made{{}, places_[body] != absent, has_group(qw, 4), has_group(vx, 3), has_group(wx, 3)};
    if (made.velocities) refuse_velocity(vx);
    if (made.angular_velocities) refuse_velocity(wx);
    const std::size_t width = lines_.cells().size();
    made.bodies.reserve(std::size_t(std::min(lines_.left(), limits::bodies)));
    while (lines_.next()) {
        if (lines_.cells().size() != width)
            lines_.fail(fmt::format("must have a cell for each column: {} (given {})", width, lines_.cells().size()));
        const std::int64_t number = before + std::int64_t(made.bodies.size()) + 1;
        if (number > limits::bodies) check_number_of_bodies(number, lines_.at(lines_.cells().front(), "poses"));
        BodyDescription& one = made.bodies.emplace_back(model_);
        one.position = vector(x, limits::coordinate);
        if (made.rotations) one.rotation = rotation();
        if (made.velocities) one.velocity = vector(vx, limits::velocity);
        if (made.angular_velocities) one.angular_velocity = vector(wx, limits::angular_velocity);
        if (!made.names) continue;
        one.name = name();
        names.take(one.name, at(body));
    }
    if (made.bodies.empty()) throw InputError({file_, 1, 1}, "has no row below the names of its columns");
    return made;
}

}  // namespace

PosedBodies read_posed_bodies(std::string_view text, const std::string& file, const BodyDescription& model,
                              BodyNames& names, std::int64_t before) {
    return PoseReader(text, file, model).read(names, before);
}

}  // namespace tumble
