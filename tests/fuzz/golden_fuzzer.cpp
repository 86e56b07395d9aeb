// A suite of golden images: the result has cases whose references lie in its folder, or is an InputError that is safe
// to print. Nothing is read but the text.
#include "app/golden/suite.h"
#include "core/check.h"
#include "core/error.h"

#include <cstdint>
#include <string>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tumble;
    try {
        const GoldenSuite suite =
            parse_suite(std::string(reinterpret_cast<const char*>(data), size), "/nowhere/golden.toml");
        TUMBLE_CHECK_EQ(suite.cases.empty(), false);
        for (const GoldenCase& golden : suite.cases) {
            TUMBLE_CHECK_EQ(suite.find(golden.name) == &golden, true);
            TUMBLE_CHECK_EQ(golden.frames.empty(), false);
            for (const std::int64_t frame : golden.frames) {
                const std::string image = golden.image_name(frame);
                TUMBLE_CHECK_EQ(image.find('/'), std::string::npos);
                const CompareOptions limits = suite.tolerances_of(image).pixels;
                TUMBLE_CHECK_EQ(limits.fraction >= 0.0 && limits.fraction <= 1.0, true);
            }
            TUMBLE_CHECK_EQ(golden.record_name().find('/'), std::string::npos);
        }
    } catch (const InputError& error) {
        const std::string_view words = error.what();
        TUMBLE_CHECK_EQ(words.starts_with("/nowhere/"), true);
        for (const char c : words) TUMBLE_CHECK_EQ(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f, true);
    }
    return 0;
}
