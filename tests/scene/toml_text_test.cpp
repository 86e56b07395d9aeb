// Parsed TOML as text again: the same scene, and the same values to the bit.
#include "scene/toml/toml_text.h"

#include "scene/hash/scene_hash.h"
#include "scene/load.h"
#include "scene/toml/set_values.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <filesystem>

namespace tumble::toml_text_test {
namespace {

namespace fs = std::filesystem;

TEST(TomlText, AllScenesStayTheSame) {
    int scenes = 0;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(TUMBLE_SOURCE_DIR) / "assets/scenes")) {
        if (entry.path().extension() != ".toml") continue;
        ++scenes;
        const toml::table document = parse_toml(read_scene_text(entry.path()), entry.path().string());
        const std::string text = toml_document_text(document);
        EXPECT_EQ(scene_hash(parse_scene(text, entry.path())), scene_hash(load_scene(entry.path()))) << entry.path();
        EXPECT_EQ(toml_document_text(parse_toml(text, "again")), text) << entry.path();
    }
    EXPECT_GT(scenes, 10);
}

TEST(TomlText, NumbersKeepTheirBits) {
    for (const double value : {0.1, 1.0 / 3.0, 5.0, -0.0, 1e22, 1e-320, 123456789.125, 1.7976931348623157e308}) {
        const toml::table parsed = parse_toml("value = " + toml_number(value), "number");
        const auto* node = parsed.get("value")->as_floating_point();
        ASSERT_NE(node, nullptr) << toml_number(value);
        EXPECT_EQ(std::bit_cast<std::uint64_t>(node->get()), std::bit_cast<std::uint64_t>(value)) << value;
    }
}

TEST(TomlText, StringsKeepTheirCharacters) {
    const std::string text = "a \"quoted\" \\ back\\slash\n\ttab \x01 \x7f \xc3\xa9 {brace}";
    const toml::table parsed = parse_toml("value = " + toml_string(text), "string");
    EXPECT_EQ(parsed.get("value")->value<std::string>(), text);
}

TEST(TomlText, KeysKeepTheirOrderAndForm) {
    toml::table document = parse_toml(
        "z = 1\n\"a b\" = [1.5, {x = 2}]\n[t]\nd = 1979-05-27T07:32:00Z\n[[list]]\nk = true\n"
        "[[list]]\n[list.inner]\nk = \"v\"\n",
        "order");
    EXPECT_EQ(toml_document_text(document),
              "z = 1\n\"a b\" = [1.5, { x = 2 }]\n\n[t]\nd = 1979-05-27T07:32:00Z\n\n[[list]]\nk = true\n\n[[list]]\n\n"
              "[list.inner]\nk = \"v\"\n");
    const std::vector<std::string> set = {"b=2", "t.a=3", "new.key=4"};
    set_values(document, set);
    EXPECT_EQ(toml_document_text(document),
              "z = 1\n\"a b\" = [1.5, { x = 2 }]\nb = 2\nnew = { key = 4 }\n\n[t]\nd = 1979-05-27T07:32:00Z\na = 3\n\n"
              "[[list]]\nk = true\n\n[[list]]\n\n[list.inner]\nk = \"v\"\n");
}

}  // namespace
}  // namespace tumble::toml_text_test
