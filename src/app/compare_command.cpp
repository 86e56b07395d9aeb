#include "app/commands.h"
#include "app/output_path.h"
#include "core/error.h"
#include "output/image_compare.h"
#include "output/png_reader.h"
#include "output/png_writer.h"

#include <fmt/format.h>

#include <cstdio>

namespace tumble {

int run_compare(const CompareCommand& command) try {
    if (!(command.fraction >= 0.0 && command.fraction <= 1.0))   // not a number passes CLI11's range
        throw InputError(fmt::format("--fraction: must be between 0 and 1 (was {})", command.fraction));
    if (command.difference)
        for (const auto& picture : {command.a, command.b}) check_output("--diff", *command.difference, picture);
    const CompareOptions options{command.tolerance, command.fraction};
    const Image a = read_png(command.a), b = read_png(command.b);
    const Comparison result = compare_images(a, b, options);
    if (command.difference) write_png(*command.difference, difference_image(a, b, options));
    if (!result.alike) {
        fmt::print("different: {}\n", result.reason);
        return 1;
    }
    if (result.differing_pixels == 0) fmt::print("alike: every pixel is the same\n");
    else fmt::print("alike: {} pixels differ, by {} levels at most\n", result.differing_pixels, result.max_difference);
    return 0;
} catch (const RunError& error) {
    // 1 says "different" here: whatever kept us from telling must not look like that.
    fmt::print(stderr, "{}\n", error.what());
    return 2;
}

}  // namespace tumble
