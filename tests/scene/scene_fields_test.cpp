// The tables of fields: no member of a description is missing in them, and docs/reference has their tables.
#include "scene/all_fields.h"
#include "scene/toml/error_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <new>
#include <regex>
#include <set>
#include <sstream>

namespace tumble::scene_fields_test {
namespace {

/// Marks the bytes of the members that have fields.
struct Coverage : FieldVisitor {
    void operator()(const auto& member, std::string_view, const auto&, const About& = {}) { add(member); }
    void inner(const auto&... members) { (add(members), ...); }
    void shown(const auto&... members) { (add(members), ...); }
    void instead(const auto& member, const auto&) { add(member); }
    void since(bool, const auto&... members) { (add(members), ...); }
    void add(const auto& member) {
        const auto offset = std::size_t(reinterpret_cast<const std::byte*>(&member) - start);
        ASSERT_LE(offset + sizeof member, covered.size()) << "a field is no member of its struct";
        ++count;
        std::fill_n(covered.begin() + std::ptrdiff_t(offset), sizeof member, true);
    }

    void add(std::string_view) {}  // a key that is hashed with its member

    const std::byte* start;
    std::vector<bool> covered;
    std::size_t count = 0;
};

/// GCC 12 takes some padding of two large structs for members: their members are counted. 0: any number.
constexpr std::size_t number_of_members(const auto&) { return 0; }
std::size_t number_of_members(const OverlayDescription& overlay) {
    [[maybe_unused]] const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r] = overlay;
    return 18;
}
std::size_t number_of_members(const JointDescription& joint) {
    [[maybe_unused]] const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x] = joint;
    return 24;
}

TEST(SceneFields, EveryMemberOfADescriptionHasAField) {
#if defined(__GNUC__) && !defined(__clang__)
    for_all_fields([]<class Struct>(const char* table) {
        const Struct one{};
        Coverage coverage{{}, reinterpret_cast<const std::byte*>(&one), std::vector<bool>(sizeof one, false), 0};
        visit_fields(Of<Struct>(), coverage, one);
        if (const std::size_t members = number_of_members(one)) {
            EXPECT_EQ(coverage.count, members) << table;
            return;
        }
        // All bytes but the padding between members; the object has its own bytes back before its end.
        Struct probe{};
        std::array<std::byte, sizeof(Struct)> own, mask;
        std::memcpy(own.data(), &probe, sizeof probe);
        std::memset(static_cast<void*>(&probe), 0xff, sizeof probe);
        __builtin_clear_padding(&probe);
        std::memcpy(mask.data(), &probe, sizeof probe);
        std::memcpy(static_cast<void*>(&probe), own.data(), sizeof probe);
        for (std::size_t i = 0; i < mask.size(); ++i)
            EXPECT_TRUE(coverage.covered[i] || mask[i] == std::byte(0))
                << "the member at byte " << i << " of [" << table << "] has no field";
    });
#else
    GTEST_SKIP() << "needs GCC's __builtin_clear_padding";
#endif
}

TEST(SceneFields, NoKeyStandsTwiceInATable) {
    for_all_fields([]<class Struct>(const char* table) {
        const std::vector<std::string_view> keys = list_keys<Struct>().keys;
        EXPECT_EQ(std::set<std::string_view>(keys.begin(), keys.end()).size(), keys.size()) << table;
    });
}

// -- The reference

std::string unit_text(std::string unit) {
    unit = std::regex_replace(unit, std::regex("\\^2"), "²");
    return std::regex_replace(unit, std::regex("\\^3"), "³");
}

std::string grouped(double value) {
    if (std::fabs(value) >= 1e7)
        return std::regex_replace(fmt::format("{:.0e}", value), std::regex("e\\+?(-?)0?"), "e$1");
    std::string text = number_text(value);
    for (std::size_t i = text.find('.') == std::string::npos ? text.size() : text.find('.'); i > 3; i -= 3)
        if (value >= 1000.0) text.insert(i - 3, ",");
    return std::regex_replace(text, std::regex("e-0?"), "e-");
}

std::string range_text(const Range& range) {
    if (range.min == -range.max) return "±" + grouped(range.max);
    if (range.min_excluded) return fmt::format("above {}, to {}", grouped(range.min), grouped(range.max));
    return fmt::format("{} to {}", grouped(range.min), grouped(range.max));
}

template <Named Enum>
std::string names_text() {
    std::vector<std::string> names;
    for (const auto& choice : choices<Enum>) names.push_back(fmt::format("`\"{}\"`", choice.name));
    return fmt::format("{}", fmt::join(names, ", "));
}

std::string default_text(double value) { return grouped(value); }
std::string default_text(int value) { return grouped(value); }
std::string default_text(std::uint64_t value) { return grouped(double(value)); }
std::string default_text(bool value) { return value ? "true" : "false"; }
std::string default_text(const Vec3& v) {
    return fmt::format("`[{}, {}, {}]`", number_text(v.x()), number_text(v.y()), number_text(v.z()));
}
std::string default_text(const Quat&) { return "none"; }
std::string default_text(Color color) { return fmt::format("`\"{}\"`", to_string(color)); }
template <Named Enum>
std::string default_text(Enum value) {
    return fmt::format("`\"{}\"`", name_of(value));
}

template <class T>
std::string type_text() {
    if constexpr (std::is_same_v<T, bool>) return "boolean";
    if constexpr (std::is_same_v<T, std::string> || Named<T>) return "string";
    if constexpr (std::is_same_v<T, Color>) return "color";
    if constexpr (std::is_same_v<T, Quat>) return "rotation";
    if constexpr (std::is_same_v<T, Vec3>) return "vector";
    if constexpr (std::integral<T>) return "whole number";
    if constexpr (std::is_same_v<T, double>) return "number";
    if constexpr (std::is_same_v<T, std::vector<Color>>) return "array of colors";
    return "";
}

std::string with_unit(const std::string& type, const Range& range) {
    return *range.unit ? fmt::format("{}, {}", type, unit_text(range.unit)) : type;
}

struct Row {
    std::string type, standard, range;
};

template <class T>
struct Plain {
    using type = T;
};
template <class T>
struct Plain<std::optional<T>> {
    using type = T;
};

/// The lines of the tables of a struct, by their sections.
struct Reference : FieldVisitor {
    template <class T, class Rule>
    void operator()(const T& value, std::string_view name, const Rule& rule, const About& about = {}) {
        using Value = typename Plain<T>::type;
        Row row{type_text<Value>(), "none", ""};
        if constexpr (requires { default_text(value); }) row.standard = default_text(value);
        if constexpr (Named<Value>) row.range = names_text<Value>();
        add_rule(row, rule);
        add(row, name, about);
    }
    void alias(const auto& value, std::string_view name, const auto& rule, const About& about = {}) {
        (*this)(value, name, rule, about);
    }
    void key(std::string_view name, const About& about = {}) { add({}, name, about); }
    void section(std::string_view name) { now = name; }

    void add_rule(Row& row, const Range& range) {
        row.type = with_unit(row.type, range);
        row.range = range_text(range);
    }
    void add_rule(Row& row, const NumberOrVector& rule) {
        row.type = with_unit("number or vector", rule.range);
        row.range = range_text(rule.range);
    }
    void add_rule(Row& row, const Whole& range) {
        row.range = range.max == INT64_MAX
                        ? fmt::format("{} and up", range.min)
                        : fmt::format("{} to {}", grouped(double(range.min)), grouped(double(range.max)));
    }
    void add_rule(Row& row, const Words& words) {
        row = {"string", fmt::format("`\"{}\"`", words.first),
               fmt::format("`\"{}\"`, `\"{}\"`", words.first, words.second)};
    }
    void add_rule(Row& row, Direction) { row.range = "not zero; its length is ignored"; }
    template <class Rule>
    void add_rule(Row& row, const Required<Rule>& required) {
        add_rule(row, required.rule);
        row.standard = "required";
    }
    void add_rule(Row& row, NotEmpty) { row.range = "not empty"; }
    void add_rule(Row&, ByType) {}
    void add_rule(Row&, ByCode) {}

    void add(const Row& row, std::string_view name, const About& about) {
        const auto either = [](std::string_view given, const std::string& made) {
            return given.empty() ? made : std::string(given);
        };
        const std::vector<std::string> cells{fmt::format("`{}`", name), either(about.type, row.type),
                                             either(about.standard, row.standard), either(about.range, row.range),
                                             std::string(about.text)};
        std::string line = "|";
        for (const std::string& cell : cells) line += cell.empty() ? " |" : fmt::format(" {} |", cell);
        std::string& table = tables[std::string(now)];
        if (table.empty()) table = "| key | type, unit | default | range | |\n|---|---|---|---|---|\n";
        table += line + "\n";
    }

    std::string_view now;
    std::map<std::string, std::string> tables;
};

/// All tables of the reference, by the names of their places in the pages.
std::map<std::string, std::string> reference_tables() {
    std::map<std::string, std::string> all;
    for_all_fields([&]<class Struct>(const char* table) {
        Reference reference;
        const Struct standard{};
        visit_fields(Of<Struct>(), reference, standard);
        for (const auto& [section, text] : reference.tables)
            all[section.empty() ? table : fmt::format("{}: {}", table, section)] = text;
    });
    return all;
}

/// Tables stand between `<!-- fields: NAME -->` and an empty line. With the environment variable TUMBLE_WRITE_REFERENCE
/// the pages get them.
TEST(SceneFields, TheReferenceHasTheirTables) {
    const bool write = std::getenv("TUMBLE_WRITE_REFERENCE") != nullptr;
    const auto tables = reference_tables();
    std::set<std::string> found;
    for (const char* name : {"scene-format.md", "scene-joints.md"}) {
        const std::string page = std::string(TUMBLE_SOURCE_DIR) + "/docs/reference/" + name;
        std::stringstream content;
        content << std::ifstream(page).rdbuf();
        std::string text = content.str(), made;
        const std::regex mark("<!-- fields: (.*) -->\n\n([^\n]+\n)*");
        std::size_t done = 0;
        for (std::sregex_iterator one(text.begin(), text.end(), mark), end; one != end; ++one) {
            const std::string table = (*one)[1];
            ASSERT_TRUE(tables.count(table)) << name << " names \"" << table << "\"";
            found.insert(table);
            made += text.substr(done, std::size_t(one->position()) - done);
            made += fmt::format("<!-- fields: {} -->\n\n{}", table, tables.at(table));
            done = std::size_t(one->position() + one->length());
        }
        made += text.substr(done);
        if (write) std::ofstream(page) << made;
        EXPECT_TRUE(write || made == text) << name
                                           << " is not current: run TUMBLE_WRITE_REFERENCE=1 "
                                              "build/release/tests/scene/scene_tests scene_fields_test.cpp";
    }
    for (const char* in_text : {"joint coordinate", "trail point", "motor keyframe"}) found.insert(in_text);
    for (const auto& [table, text] : tables)
        EXPECT_TRUE(found.count(table)) << "no page has the table \"" << table << "\"";
}

}  // namespace
}  // namespace tumble::scene_fields_test
