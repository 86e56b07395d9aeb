// The JSON of a glTF file, and its members by kind; a violation of glTF is a MeshError.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>
#include <string_view>

namespace tumble {

using Json = nlohmann::json;

/// Parses the text. Throws MeshError if it is not JSON or has more values than limits::json_values. Depth needs no
/// stack.
Json parse_json(std::string_view text);

/// The member of that name, or null. `object` may be of any kind.
const Json* find_member(const Json& object, const char* name);

/// A member that is an integer of 0 or more; empty if it is missing.
std::optional<std::uint64_t> find_whole(const Json& object, const char* name);
/// The same for a required member.
std::uint64_t require_whole(const Json& object, const char* name);
/// The elements of a member that is an array of integers; empty if it is missing.
std::vector<std::uint64_t> whole_numbers(const Json& object, const char* name);
/// A member that is an array of `count` numbers; empty if it is missing.
std::optional<std::vector<float>> find_floats(const Json& object, const char* name, std::size_t count);

/// Item `index` of the array `name` of the document, an object.
const Json& require_item(const Json& document, const char* name, std::uint64_t index);

}  // namespace tumble
