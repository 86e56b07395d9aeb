#include "output/png_compare.h"

#include "output/png_reader.h"
#include "output/png_writer.h"

#include <optional>
#include <vector>

namespace tumble {

Comparison compare_png_files(const std::filesystem::path& a, const std::filesystem::path& b,
                             const CompareOptions& options, const std::filesystem::path& difference_file) {
    PngRows rows_a(a), rows_b(b);
    const PictureSize size = rows_a.size();
    check_sizes(size.width, size.height, rows_b.size().width, rows_b.size().height);
    ImageComparer comparer(size.width, size.height, options);
    std::optional<PngRowWriter> difference;
    std::vector<std::uint8_t> row;
    if (!difference_file.empty()) {
        difference.emplace(difference_file, size.width, size.height);
        row.resize(4 * std::size_t(size.width));
    }
    for (int y = 0; y < size.height; ++y) {
        const auto row_a = rows_a.next(), row_b = rows_b.next();
        comparer.add_row(row_a, row_b);
        if (!difference) continue;
        difference_row(row_a, row_b, options.tolerance, row);
        difference->add_row(row);
    }
    if (difference) difference->finish();
    return comparer.result();
}

}  // namespace tumble
