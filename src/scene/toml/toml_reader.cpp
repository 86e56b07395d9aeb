#define TOML_IMPLEMENTATION  // toml++ is compiled here, and only declared elsewhere
#include "scene/toml/toml_reader.h"

#include "core/available_memory.h"
#include "core/error.h"
#include "core/input_file.h"
#include "core/safe_text.h"
#include "scene/toml/limits.h"
#include "scene/toml/range.h"
#include "scene/toml/set_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>

namespace tumble {
namespace {

// -- The amounts of a text before it is parsed: the parser builds its whole tree first, and a small text can define a
// deep or a large one.

struct TomlAmounts {
    std::size_t keys = 0;   // with all parts of dotted ones, including tables
    std::size_t items = 0;  // of arrays, and inline tables
};

// Bytes of toml++ 3.3's nodes on the heap (glibc, x86-64), measured with some million of each: keys of numbers take 173
// and of tables 220, items 59 to 103. A refused text certainly does not fit.
constexpr std::uint64_t key_bytes = 170, item_bytes = 59;

/// A line break ends an unclosed string of one line: the parser reports an error there.
std::size_t end_of_string(std::string_view text, std::size_t first) {
    const char quote = text[first];
    const bool escapes = quote == '"';
    const std::string_view triple = text.substr(first, 3);
    const bool lines = triple.size() == 3 && triple[1] == quote && triple[2] == quote;
    for (std::size_t i = first + (lines ? 3 : 1); i < text.size(); ++i) {
        if (escapes && text[i] == '\\')
            ++i;
        else if (!lines && (text[i] == quote || text[i] == '\n'))
            return i + 1;
        else if (lines && text.substr(i, 3) == triple)
            return i + 3;
    }
    return text.size();
}

struct Scan {
    TomlAmounts amounts;
    std::optional<std::size_t> deep_key;  // position of a key with too many parts
};

Scan scanned(std::string_view text) {
    Scan scan;
    std::size_t dots = 0;  // in the current key or number
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (c == '"' || c == '\'') {
            i = end_of_string(text, i);
            continue;
        }
        ++i;
        switch (c) {
            case '.':
                if (++dots >= std::size_t(limits::key_parts) && !scan.deep_key) scan.deep_key = i - 1;
                break;
            case '#':
                i = std::min(text.find('\n', i), text.size());
                break;
            case '=':
                scan.amounts.keys += dots + 1;
                dots = 0;
                break;
            case ']':
                if (dots > 1) scan.amounts.keys += dots;  // a header; a number has one
                dots = 0;
                break;
            case '[':
            case '{':
            case ',':
                ++scan.amounts.items;
                dots = 0;
                break;
            case '}':
            case '\n':
                dots = 0;
                break;
            default:  // of keys, numbers and words
                break;
        }
    }
    return scan;
}

/// Columns count characters, like the parser's.
SourceLocation location_in(std::string_view text, std::size_t at, const std::string& file) {
    const std::string_view before = text.substr(0, at);
    const std::size_t line_start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
    const auto starts_character = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };
    return {file, 1 + int(std::count(before.begin(), before.end(), '\n')),
            1 + int(std::count_if(before.begin() + std::ptrdiff_t(line_start), before.end(), starts_character))};
}

/// Throws InputError at a key with too many parts, because each part is a table within the one before (the parser
/// itself limits the depth of arrays and inline tables), and RunError if the tree takes more memory than is available.
void check_toml_amounts(std::string_view text, const std::string& file) {
    const Scan scan = scanned(text);
    if (scan.deep_key)
        throw InputError(
            location_in(text, *scan.deep_key, file),
            fmt::format("a key has more than {} parts, which is deeper than a scene goes", limits::key_parts));
    const auto [keys, items] = scan.amounts;
    require_memory(key_bytes * keys + item_bytes * items, fmt::format("a scene of {} keys and {} items", keys, items),
                   "a grid or scatter makes many bodies of one table");
}

// -- Values

SourceLocation location_of(const toml::source_region& source, const std::string& file) {
    return {file, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

/// Position of a value: in the file, or the option that set it.
SourcePosition position_of(std::string_view key, const toml::source_region& source, const std::string& file) {
    const auto option = set_option(source);
    if (!option) return {std::string(key), location_of(source, file)};
    const bool whole = option->ends_with(key);
    return {whole ? *option : fmt::format("{}.{}", *option, key), {}};
}

/// The array for a message: as many items as fit into `room` bytes, and the total number.
std::string given_text(const toml::array& array, std::size_t room);

/// The value for a message, of readable length and on one line.
std::string given_text(const toml::node& node, std::size_t room = value_text_bytes) {
    if (const auto* s = node.as_string()) return fmt::format("\"{}\"", safe_text(s->get()));
    if (const auto* i = node.as_integer()) return fmt::format("{}", i->get());
    if (const auto* f = node.as_floating_point()) return number_text(f->get());
    if (const auto* b = node.as_boolean()) return b->get() ? "true" : "false";
    if (node.is_table()) return "a table";
    if (const auto* array = node.as_array()) return given_text(*array, room);
    return "a date or time";
}

std::string given_text(const toml::array& array, std::size_t room) {
    std::string text = "[";
    for (const toml::node& item : array) {
        if (text.size() > 1) text += ", ";
        const std::string next = text.size() < room ? given_text(item, room - text.size()) : std::string();
        if (text.size() + next.size() >= room) return fmt::format("{}... ({} items)]", text, array.size());
        text += next;
    }
    return text + "]";
}

constexpr std::size_t longest_syntax_error = 240;  // bytes: a sentence of the parser with the rejected text

}  // namespace

toml::table parse_toml(const std::string& text, const std::string& file) {
    check_toml_amounts(text, file);
    try {
        return toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        throw InputError(location_of(error.source(), file), safe_text(error.description(), longest_syntax_error));
    }
}

// -- TomlValue

void TomlValue::fail(std::string_view problem) const {
    origin_.fail(fmt::format("{} (given {})", problem, given_text(*node_)));
}

double TomlValue::number(const Range& range) const {
    if (!node_->is_number()) fail("must be a number");
    const double value =
        node_->is_integer() ? static_cast<double>(node_->as_integer()->get()) : node_->as_floating_point()->get();
    return checked(value, range, origin_);
}

double TomlValue::frame_rate() const { return is_text() ? read_rate_fraction(text(), origin_) : number(limits::fps); }

std::int64_t TomlValue::integer(std::int64_t min, std::int64_t max) const {
    if (!node_->is_integer()) fail("must be a whole number");
    return checked(node_->as_integer()->get(), min, max, origin_);
}

bool TomlValue::boolean() const {
    if (!node_->is_boolean()) fail("must be true or false");
    return node_->as_boolean()->get();
}

std::string TomlValue::text() const {
    if (!node_->is_string()) fail("must be a string");
    const std::string& text = node_->as_string()->get();
    // Names of files would end there, and so would texts of pictures.
    if (text.find('\0') != std::string::npos) fail("must have no zero byte");
    return text;
}

Color TomlValue::color() const {
    if (node_->is_string()) {
        if (const auto color = parse_color(node_->as_string()->get())) return *color;
    }
    fail("must be a color \"#rrggbb\"");
}

Vec3 TomlValue::vector(const Range& range) const {
    const auto component = items(3, "numbers");
    return {component[0].number(range), component[1].number(range), component[2].number(range)};
}

Vec3 TomlValue::direction() const {
    const Vec3 v = vector(limits::direction);
    const double largest = v.cwiseAbs().maxCoeff();
    if (largest == 0.0) fail("must not be zero");
    return (v / largest).normalized();  // scaled first, because squares of tiny components would vanish
}

TomlTable TomlValue::table() const {
    if (!node_->is_table()) fail("must be a table");
    return TomlTable(*node_->as_table(), origin_, origin_.name);
}

std::vector<TomlValue> TomlValue::items() const {
    if (!node_->is_array()) fail("must be an array");
    std::vector<TomlValue> result;
    for (const toml::node& item : *node_->as_array()) result.push_back(item_of(item));
    return result;
}

TomlValue TomlValue::item_of(const toml::node& item) const {
    if (origin_.is_option()) return {item, origin_};
    return {item, {origin_.name, location_of(item.source(), origin_.where.file)}};
}

std::vector<TomlValue> TomlValue::items(std::size_t count, std::string_view kind) const {
    if (!node_->is_array() || node_->as_array()->size() != count)
        fail(fmt::format("must be an array of {} {}", count, kind));
    return items();
}

std::vector<TomlTable> TomlValue::tables(std::string_view hint) const {
    if (!node_->is_array()) fail(fmt::format("must be an array of tables{}", hint));
    std::vector<TomlTable> result;
    for (const toml::node& item : *node_->as_array()) result.push_back(item_of(item).table());
    return result;
}

// -- TomlTable

void TomlTable::expect_keys(const std::vector<std::string_view>& known) const {
    const toml::key* first = nullptr;
    for (const auto& [key, node] : *table_) {
        if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
        if (first == nullptr || key.source().begin < first->source().begin) first = &key;
    }
    if (first == nullptr) return;
    const std::string problem = fmt::format("unknown key \"{}\" in {}{}", safe_text(first->str()), safe_text(title_),
                                            suggestion(first->str(), known));
    const SourcePosition position = position_of(first->str(), first->source(), origin_.where.file);
    if (position.is_option()) position.fail(problem);
    throw InputError(position.where, problem);
}

SourcePosition TomlTable::origin_of(std::string_view key, const toml::node& node) const {
    return position_of(key, node.source(), origin_.where.file);
}

std::optional<TomlValue> TomlTable::find(std::string_view key) const {
    const toml::node* node = table_->get(key);
    if (!node) return std::nullopt;
    return TomlValue(*node, origin_of(key, *node));
}

TomlValue TomlTable::require(std::string_view key) const {
    if (auto value = find(key)) return *value;
    throw InputError(origin_.where, fmt::format("{} needs \"{}\" (not given)", safe_text(title_), key));
}

std::optional<TomlTable> TomlTable::find_table(std::string_view key) const {
    const auto value = find(key);
    if (!value) return std::nullopt;
    TomlTable table = value->table();
    table.set_title(fmt::format("[{}]", key));
    return table;
}

std::vector<std::pair<std::string, TomlValue>> TomlTable::entries() const {
    std::vector<std::pair<const toml::key*, const toml::node*>> places;
    for (const auto& [key, node] : *table_) places.emplace_back(&key, &node);
    std::sort(places.begin(), places.end(),
              [](const auto& a, const auto& b) { return a.first->source().begin < b.first->source().begin; });
    std::vector<std::pair<std::string, TomlValue>> result;
    for (const auto& [key, node] : places)
        result.emplace_back(std::string(key->str()), TomlValue(*node, origin_of(key->str(), *node)));
    return result;
}

void TomlTable::read(std::string_view key, double& target, const Range& range) const {
    if (const auto value = find(key)) target = value->number(range);
}
void TomlTable::read(std::string_view key, std::optional<double>& target, const Range& range) const {
    if (const auto value = find(key)) target = value->number(range);
}
void TomlTable::read(std::string_view key, Vec3& target, const Range& range) const {
    if (const auto value = find(key)) target = value->vector(range);
}
void TomlTable::read(std::string_view key, bool& target) const {
    if (const auto value = find(key)) target = value->boolean();
}
void TomlTable::read(std::string_view key, std::string& target) const {
    if (const auto value = find(key)) target = value->text();
}
void TomlTable::read(std::string_view key, Color& target) const {
    if (const auto value = find(key)) target = value->color();
}

std::string read_toml_file(const std::filesystem::path& file, const std::string& what, std::int64_t most_bytes) {
    return read_input_file(file, "the " + what, most_bytes);
}

}  // namespace tumble
