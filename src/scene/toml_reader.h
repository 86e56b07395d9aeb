// Typed reading of a TOML document in which every value knows its place, so that every complaint can point.
// TomlTable hands out values by key and rejects keys that nobody knows; TomlValue turns into a number, a vector, a
// colour, ... of the wanted kind and range, or throws InputError at its line and column.
#pragma once

#include "core/color.h"
#include "core/vector.h"
#include "scene/origin.h"
#include "scene/range.h"

// toml++ 3.3 asserts that a key begins with a key's character before it checks it ("[?]" ends a debug build).
#define TOML_ASSERT(expr) static_assert(true)
#include <toml++/toml.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tumble {

class TomlTable;

class TomlValue {
public:
    TomlValue(const toml::node& node, Origin origin) : node_(&node), origin_(std::move(origin)) {}

    const Origin& origin() const { return origin_; }
    bool is_number() const { return node_->is_number(); }
    bool is_table() const { return node_->is_table(); }

    double number(const Range& range) const;   // integers are numbers too
    std::int64_t integer(std::int64_t min, std::int64_t max) const;
    bool boolean() const;
    std::string text() const;
    Color color() const;                        // "#rrggbb"
    Vec3 vector(const Range& range) const;      // each component in the range
    Vec3 direction() const;                     // unit vector along three numbers that are not all zero
    TomlTable table() const;
    std::vector<TomlValue> items() const;       // of an array
    std::vector<TomlValue> items(std::size_t count, std::string_view kind) const;   // of an array of that length
    std::vector<TomlTable> tables(std::string_view hint = "") const;                // of an array of tables

    template <class Value>
    Value choice(std::span<const Choice<Value>> choices) const {
        return chosen(text(), choices, origin_);
    }

    /// Throws "NAME PROBLEM (given ...)" at this value's place.
    [[noreturn]] void fail(std::string_view problem) const;

private:
    TomlValue item_of(const toml::node& item) const;

    const toml::node* node_;
    Origin origin_;
};

class TomlTable {
public:
    /// `title` names the table in messages: "[simulation]", "a box".
    TomlTable(const toml::table& table, Origin origin, std::string title)
        : table_(&table), origin_(std::move(origin)), title_(std::move(title)) {}

    const Origin& origin() const { return origin_; }
    void set_title(std::string title) { title_ = std::move(title); }

    /// Throws at the first key (in file order) that is not among these, naming the nearest that is.
    void expect_keys(std::initializer_list<std::string_view> known) const;

    bool has(std::string_view key) const { return table_->contains(key); }
    std::optional<TomlValue> find(std::string_view key) const;
    TomlValue require(std::string_view key) const;

    /// The sub-table of a key; empty when it is absent.
    std::optional<TomlTable> find_table(std::string_view key) const;

    /// All entries in file order, for tables whose keys are the user's own names.
    std::vector<std::pair<std::string, TomlValue>> entries() const;

    // Sets the target when the key is there, and leaves its default when not.
    void read(std::string_view key, double& target, const Range& range) const;
    void read(std::string_view key, std::optional<double>& target, const Range& range) const;
    void read(std::string_view key, Vec3& target, const Range& range) const;
    void read(std::string_view key, bool& target) const;
    void read(std::string_view key, std::string& target) const;
    void read(std::string_view key, Color& target) const;
    template <class Value>
    void read(std::string_view key, Value& target, std::span<const Choice<Value>> choices) const {
        if (const auto value = find(key)) target = value->choice(choices);
    }

private:
    Origin origin_of(std::string_view key, const toml::node& node) const;

    const toml::table* table_;
    Origin origin_;
    std::string title_;
};

/// Parses the text; a syntax error becomes an InputError at the parser's place in `file`.
toml::table parse_toml(const std::string& text, const std::string& file);

}  // namespace tumble
