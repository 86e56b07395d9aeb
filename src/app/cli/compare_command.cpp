#include "app/cli/commands.h"
#include "app/cli/say.h"
#include "app/files/output_plan.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/image_compare.h"
#include "output/png_reader.h"
#include "output/png_writer.h"

#include <fmt/format.h>

#include <exception>
#include <new>
#include <optional>
#include <string>
#include <vector>

namespace tumble {
namespace {

/// Row by row, so that pictures of any size take little memory.
Comparison compared(const CompareCommand& command) {
    if (command.difference) {
        OutputPlan plan;
        for (const auto& picture : {command.a, command.b}) plan.add_input(picture);
        plan.add("--diff", *command.difference);
    }
    PngRows a(command.a), b(command.b);
    const PictureSize size = a.size();
    check_sizes(size.width, size.height, b.size().width, b.size().height);
    ImageComparer comparer(size.width, size.height, command.options);
    std::optional<PngRowWriter> difference;
    std::vector<std::uint8_t> row;
    if (command.difference) {
        difference.emplace(*command.difference, size.width, size.height);
        row.resize(4 * std::size_t(size.width));
    }
    for (int y = 0; y < size.height; ++y) {
        const auto row_a = a.next(), row_b = b.next();
        comparer.add_row(row_a, row_b);
        if (!difference) continue;
        difference_row(row_a, row_b, command.options.tolerance, row);
        difference->add_row(row);
    }
    if (difference) difference->finish();
    return comparer.result();
}

void print(const Comparison& result) {
    const std::string differences =
        fmt::format("{} pixels differ, by {} levels at most", result.differing_pixels, result.max_difference);
    if (!result.alike)
        put("different: {}\n{}, at x {}, y {}\n", result.reason, differences, result.max_x, result.max_y);
    else if (result.differing_pixels == 0)
        put("alike: every pixel is the same\n");
    else
        put("alike: {}\n", differences);
    finish_standard_output();
}

// Exit code 1 means "different", so every failure of the comparison itself must be 2.
int cannot_tell(const std::string& words) {
    say("{}\n", words);
    return 2;
}

}  // namespace

int run_compare(const CompareCommand& command) try {
    const CompareOptions& options = command.options;
    if (!(options.fraction >= 0.0 && options.fraction <= 1.0))  // CLI11's range check lets NaN through
        throw InputError(fmt::format("--fraction: must be between 0 and 1 (was {})", options.fraction));
    const Comparison result = compared(command);
    print(result);
    return result.alike ? 0 : 1;
} catch (const RunError& error) {
    return cannot_tell(error.what());
} catch (const std::bad_alloc&) {
    return cannot_tell("error: out of memory");
} catch (const InputError&) {
    throw;
} catch (const std::exception& error) {
    return cannot_tell(fmt::format("error: {}", safe_lines(error.what())));
}

}  // namespace tumble
