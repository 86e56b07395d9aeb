#include "scene/keys/posed_bodies.h"

#include "core/safe_text.h"
#include "scene/fields/many_bodies_fields.h"
#include "scene/keys/bodies.h"
#include "scene/toml/error_text.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

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

/// The columns of a field of PoseRow.
struct ColumnGroup {
    std::string_view key;  // "x,y,z"
    bool required;
    std::size_t first, count;  // among all columns
    bool given = false;
};

template <class Rule>
constexpr bool is_required = false;
template <class Rule>
constexpr bool is_required<Required<Rule>> = true;

/// The fields of PoseRow as groups of columns.
struct GroupList : FieldVisitor {
    template <class Rule>
    void operator()(const auto&, std::string_view key, const Rule&, const About& = {}) {
        const std::size_t first = columns.size();
        for (std::string_view rest = key; !rest.empty();) {
            const std::size_t end = std::min(rest.find(','), rest.size());
            columns.push_back(rest.substr(0, end));
            rest.remove_prefix(std::min(end + 1, rest.size()));
        }
        groups.push_back({key, is_required<Rule>, first, columns.size() - first});
    }

    std::vector<std::string_view> columns;
    std::vector<ColumnGroup> groups;
};

constexpr std::size_t absent = SIZE_MAX;

class PoseReader {
public:
    PoseReader(std::string_view text, const std::string& file, const BodyDescription& model)
        : lines_(text, file), file_(file), model_(model) {
        const PoseRow row;
        visit_fields(Of<PoseRow>(), known_, row);
    }

    PosedBodies read(BodyNames& names, std::int64_t before);

private:
    /// Reads the fields of a row whose columns the file has, in the order of known_.groups.
    struct RowReader : FieldVisitor {
        RowReader(const PoseReader& from) : file(from) {}
        void operator()(auto& target, std::string_view, const auto& rule, const About& = {}) {
            if (group->given) file.read_value(target, group->first, rule);
            ++group;
        }

        const PoseReader& file;
        std::vector<ColumnGroup>::const_iterator group = file.known_.groups.begin();
    };

    void read_header();
    bool has_group(const ColumnGroup& group) const;
    const Cell& cell(std::size_t column) const { return lines_.cells()[places_[column]]; }
    SourcePosition at(std::size_t column) const { return lines_.at(cell(column), known_.columns[column]); }
    double number(std::size_t column, const Range& range) const;

    void read_value(Vec3& target, std::size_t first, const Range& range) const {
        for (std::size_t k = 0; k < 3; ++k) target[Eigen::Index(k)] = number(first + k, range);
    }
    template <class Rule>
    void read_value(Vec3& target, std::size_t first, const Required<Rule>& required) const {
        read_value(target, first, required.rule);
    }
    void read_value(Quat& target, std::size_t first, ByType) const;
    void read_value(std::string& target, std::size_t column, NotEmpty) const;

    CsvLines lines_;
    const std::string& file_;
    const BodyDescription& model_;
    GroupList known_;
    std::vector<std::size_t> places_;  // in a line, by column
};

void PoseReader::read_header() {
    places_.assign(known_.columns.size(), absent);
    if (!lines_.next()) throw InputError({file_, 1, 1}, "is empty: the first line names the columns, such as x,y,z");
    for (std::size_t i = 0; i < lines_.cells().size(); ++i) {
        const Cell& cell = lines_.cells()[i];
        const auto known = std::ranges::find(known_.columns, cell.text);
        if (known == known_.columns.end())
            throw InputError(lines_.at(cell, {}).where, fmt::format("unknown column \"{}\"{}", safe_text(cell.text),
                                                                    suggestion(cell.text, known_.columns)));
        std::size_t& place = places_[std::size_t(known - known_.columns.begin())];
        if (place != absent) lines_.at(cell, cell.text).fail("is there twice");
        place = i;
    }
    for (ColumnGroup& group : known_.groups) group.given = has_group(group);
}

/// Columns that go together. Fails if some are missing.
bool PoseReader::has_group(const ColumnGroup& group) const {
    const auto places = std::span(places_).subspan(group.first, group.count);
    const auto missing = std::ranges::find(places, absent);
    if (missing == places.end()) return true;
    const auto is_absent = [](std::size_t place) { return place == absent; };
    if (!group.required && std::ranges::all_of(places, is_absent)) return false;
    const auto columns = std::span(known_.columns).subspan(group.first, group.count);
    lines_.fail(fmt::format("has no column \"{}\": {} go together", columns[std::size_t(missing - places.begin())],
                            fmt::join(columns, ", ")));
}

double PoseReader::number(std::size_t column, const Range& range) const {
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

void PoseReader::read_value(Quat& target, std::size_t first, ByType) const {
    Vec3 v;
    read_value(v, first + 1, quaternion_component);
    const Quat q(number(first, quaternion_component), v.x(), v.y(), v.z());
    const double norm = q.norm();
    if (!(std::fabs(norm - 1.0) <= limits::quaternion_tolerance))
        at(first).fail(fmt::format("must begin a quaternion of length 1 (given one of length {:.6g})", norm));
    target = q.normalized();
}

void PoseReader::read_value(std::string& name, std::size_t column, NotEmpty) const {
    name = cell(column).text;
    const bool quoted = cell(column).quoted;
    for (std::size_t i = 0; quoted && (i = name.find("\"\"", i)) != std::string::npos; ++i) name.erase(i, 1);
    if (name.empty()) at(column).fail("must not be empty");
    if (safe_text(name, name.size() + 1) != name)
        at(column).fail(fmt::format("must be printable UTF-8 (given \"{}\")", safe_text(name)));
}

PosedBodies PoseReader::read(BodyNames& names, std::int64_t before) {
    read_header();
    PosedBodies made;
    for (const ColumnGroup& group : known_.groups) {
        if (!group.given) continue;
        made.columns.push_back(group.key);
        const bool is_velocity = group.key == "vx,vy,vz" || group.key == "wx,wy,wz";
        if (is_velocity && model_.type != BodyType::dynamic)
            at(group.first).fail("is for dynamic bodies: leave the column out");
    }
    const bool named = made.has("body");
    const std::size_t body = std::size_t(std::ranges::find(known_.columns, "body") - known_.columns.begin());
    const std::size_t width = lines_.cells().size();
    made.bodies.reserve(std::size_t(std::min(lines_.left(), limits::bodies)));
    while (lines_.next()) {
        if (lines_.cells().size() != width)
            lines_.fail(fmt::format("must have a cell for each column: {} (given {})", width, lines_.cells().size()));
        const std::int64_t number = before + std::int64_t(made.bodies.size()) + 1;
        if (number > limits::bodies) check_number_of_bodies(number, lines_.at(lines_.cells().front(), "poses"));
        BodyDescription& one = made.bodies.emplace_back(model_);
        RowReader reader(*this);
        visit_fields(Of<PoseRow>(), reader, one);
        if (named) names.take(one.name, at(body));
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
