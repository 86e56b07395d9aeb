// A file of tolerances: the result has limits for any name, or is an InputError that is safe to print.
#include "compare/tolerances.h"
#include "core/check.h"
#include "core/error.h"

#include <cstdint>
#include <string>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    try {
        const auto tolerances = tumble::Tolerances::parse(text, "/nowhere/tolerances.toml");
        for (const std::string_view name : {"a.png", "deep/er/frame_000041.png", "", "/", "[*].png"}) {
            const tumble::CompareOptions limits = tolerances.of(name).pixels;
            TUMBLE_CHECK_EQ(limits.tolerance >= 0 && limits.tolerance <= 255, true);
            TUMBLE_CHECK_EQ(limits.fraction >= 0.0 && limits.fraction <= 1.0, true);
        }
        tolerances.unused({"a.png"});
        tumble::IgnoredPixels(tolerances.of("a.png").masks, 40, 30);
    } catch (const tumble::InputError& error) {
        for (const char c : std::string_view(error.what()))
            TUMBLE_CHECK_EQ(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f, true);
    }
    return 0;
}
