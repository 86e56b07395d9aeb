// The JSON of a glTF file, and its members by kind; whatever is not as glTF wants it is a MeshError.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>
#include <string_view>

namespace tumble {

using Json = nlohmann::json;

/// Parses the text. Throws MeshError when it is no JSON or holds more values than limits::json_values. Depth costs no stack.
Json parse_json(std::string_view text);

/// The member of that name, or nothing. `object` may be of any kind.
const Json* find_member(const Json& object, const char* name);

/// A member that is a whole number of 0 or more; nothing when it is not there.
std::optional<std::uint64_t> find_whole(const Json& object, const char* name);
/// The same, which must be there.
std::uint64_t require_whole(const Json& object, const char* name);
/// The elements of a member that is an array of whole numbers; none when it is not there.
std::vector<std::uint64_t> whole_numbers(const Json& object, const char* name);
/// A member that is an array of so many numbers; nothing when it is not there.
std::optional<std::vector<float>> find_floats(const Json& object, const char* name, std::size_t count);

/// Item `index` of the array `name` of the document, an object.
const Json& require_item(const Json& document, const char* name, std::uint64_t index);

}  // namespace tumble
