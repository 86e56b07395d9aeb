// A scene file: the result is a description or an InputError that is safe to print.
#include "core/check.h"
#include "core/error.h"
#include "scene/load.h"

#include <cstdint>
#include <string>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        tumble::parse_scene(std::string(reinterpret_cast<const char*>(data), size), "/nowhere/scene.toml");
    } catch (const tumble::InputError& error) {
        const std::string_view words = error.what();
        TUMBLE_CHECK_EQ(words.starts_with("/nowhere/scene.toml:"), true);
        for (const char c : words) TUMBLE_CHECK_EQ(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f, true);
    }
    return 0;
}
