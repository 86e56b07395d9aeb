// A file of poses: the result is bodies within the limits or an InputError that is safe to print.
#include "core/check.h"
#include "core/error.h"
#include "scene/keys/bodies.h"
#include "scene/keys/posed_bodies.h"
#include "scene/toml/limits.h"

#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tumble;
    BodyDescription model;
    model.shape = SphereShape{1.0};
    BodyNames names({});
    try {
        const std::string_view text(reinterpret_cast<const char*>(data), size);
        for (const BodyDescription& body : read_posed_bodies(text, "/nowhere/poses.csv", model, names, 0).bodies) {
            for (const double x : body.position) TUMBLE_CHECK_EQ(limits::coordinate.contains(x), true);
            for (const double v : body.velocity) TUMBLE_CHECK_EQ(limits::velocity.contains(v), true);
            TUMBLE_CHECK_EQ(body.rotation.norm() < 1.0 + 1e-9 && body.rotation.norm() > 1.0 - 1e-9, true);
        }
    } catch (const InputError& error) {
        const std::string_view words = error.what();
        TUMBLE_CHECK_EQ(words.starts_with("/nowhere/poses.csv:"), true);
        for (const char c : words) TUMBLE_CHECK_EQ(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f, true);
    }
    return 0;
}
