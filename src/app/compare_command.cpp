#include "app/commands.h"
#include "app/output_plan.h"
#include "app/say.h"
#include "core/error.h"
#include "output/image_compare.h"
#include "output/png_reader.h"
#include "output/png_writer.h"

#include <fmt/format.h>

namespace tumble {

int run_compare(const CompareCommand& command) try {
    if (!(command.fraction >= 0.0 && command.fraction <= 1.0))   // not a number passes CLI11's range
        throw InputError(fmt::format("--fraction: must be between 0 and 1 (was {})", command.fraction));
    if (command.difference) {
        OutputPlan plan;
        for (const auto& picture : {command.a, command.b}) plan.add_input(picture);
        plan.add("--diff", *command.difference);
    }
    const CompareOptions options{command.tolerance, command.fraction};
    const Image a = read_png(command.a), b = read_png(command.b);
    const Comparison result = compare_images(a, b, options);
    if (command.difference) write_png(*command.difference, difference_image(a, b, options));
    if (!result.alike) {
        put("different: {}\n", result.reason);
    } else if (result.differing_pixels == 0) {
        put("alike: every pixel is the same\n");
    } else {
        put("alike: {} pixels differ, by {} levels at most\n", result.differing_pixels, result.max_difference);
    }
    finish_standard_output();
    return result.alike ? 0 : 1;
} catch (const RunError& error) {
    // 1 says "different" here: whatever kept us from telling must not look like that.
    say("{}\n", error.what());
    return 2;
}

}  // namespace tumble
