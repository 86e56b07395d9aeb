#include "scene/mesh/gltf_json.h"

#include "scene/mesh/mesh_file.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

namespace tumble {

namespace {

/// Counts the values of a text and stops beyond the limit. (The parser's own filter rescans an array for each object in
/// it.)
class Counter : public nlohmann::json_sax<Json> {
public:
    bool too_many() const { return values_ > limits::json_values; }

    bool null() override { return count(); }
    bool boolean(bool) override { return count(); }
    bool number_integer(number_integer_t) override { return count(); }
    bool number_unsigned(number_unsigned_t) override { return count(); }
    bool number_float(number_float_t, const string_t&) override { return count(); }
    bool string(string_t&) override { return count(); }
    bool binary(binary_t&) override { return count(); }
    bool key(string_t&) override { return true; }
    bool start_object(std::size_t) override { return count(); }
    bool end_object() override { return true; }
    bool start_array(std::size_t) override { return count(); }
    bool end_array() override { return true; }
    bool parse_error(std::size_t, const std::string&, const Json::exception&) override { return false; }

private:
    bool count() { return ++values_ <= limits::json_values; }
    std::int64_t values_ = 0;
};

}  // namespace

Json parse_json(std::string_view text) {
    Counter counter;
    Json::sax_parse(text.begin(), text.end(), &counter);  // a syntax error is found again below
    if (counter.too_many()) throw MeshError(fmt::format("holds more than {} JSON values", limits::json_values));
    try {
        return Json::parse(text.begin(), text.end());
    } catch (const Json::parse_error& error) {
        throw MeshError(fmt::format("is not JSON (a mistake at byte {} of {})", error.byte, text.size()));
    } catch (const Json::exception&) {
        throw MeshError("is JSON with a number beyond all range");
    }
}

const Json* find_member(const Json& object, const char* name) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(name);
    return found == object.end() ? nullptr : &*found;
}

namespace {

std::uint64_t whole(const Json& value, const char* name) {
    if (!value.is_number_unsigned()) throw MeshError(fmt::format("has a \"{}\" that is not a whole number", name));
    return value.get<std::uint64_t>();
}

const Json* find_array(const Json& object, const char* name) {
    const Json* value = find_member(object, name);
    if (value && !value->is_array()) throw MeshError(fmt::format("has \"{}\" that is not an array", name));
    return value;
}

}  // namespace

std::optional<std::uint64_t> find_whole(const Json& object, const char* name) {
    const Json* value = find_member(object, name);
    if (!value) return std::nullopt;
    return whole(*value, name);
}

std::uint64_t require_whole(const Json& object, const char* name) {
    const auto value = find_whole(object, name);
    if (!value) throw MeshError(fmt::format("lacks a \"{}\"", name));
    return *value;
}

std::vector<std::uint64_t> whole_numbers(const Json& object, const char* name) {
    std::vector<std::uint64_t> result;
    if (const Json* array = find_array(object, name))
        for (const Json& item : *array) result.push_back(whole(item, name));
    return result;
}

std::optional<std::vector<float>> find_floats(const Json& object, const char* name, std::size_t count) {
    const Json* array = find_array(object, name);
    if (!array) return std::nullopt;
    if (array->size() != count)
        throw MeshError(fmt::format("has a \"{}\" of {} numbers, not {}", name, array->size(), count));
    std::vector<float> result;
    for (const Json& item : *array) {
        if (!item.is_number()) throw MeshError(fmt::format("has a \"{}\" with something that is not a number", name));
        result.push_back(static_cast<float>(item.get<double>()));
    }
    return result;
}

const Json& require_item(const Json& document, const char* name, std::uint64_t index) {
    const Json* array = find_array(document, name);
    const std::size_t size = array ? array->size() : 0;
    if (index >= size) throw MeshError(fmt::format("names item {} of \"{}\", which holds {}", index, name, size));
    const Json& item = (*array)[index];
    if (!item.is_object()) throw MeshError(fmt::format("has an item of \"{}\" that is not an object", name));
    return item;
}

}  // namespace tumble
