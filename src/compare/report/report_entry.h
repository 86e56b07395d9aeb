// The parts of a report for one image, as HTML.
#pragma once

#include "compare/comparison.h"
#include "compare/report/report_pictures.h"

#include <string>
#include <vector>

namespace tumble {

struct ReportEntry {
    const ImageResult* result;
    const PairPictures* pictures;
    int number;  // from 1, the worst first: "image-1" is the address of its details
};

/// The item of the list of images.
std::string list_item_html(const ReportEntry& entry);

/// Everything about the image: its causes, pictures and figures.
std::string details_html(const ReportEntry& entry);

// The order of a report: the worst first.

/// The measured value in units of its limit: above 1 where the rule fails. At most 1e6.
double excess(const RuleFigure& figure);

/// The figure with the largest excess; null if there is none.
const RuleFigure* worst_figure(const ImageResult& result);

/// All images that are not the same, the worst verdict first, and then by their largest excess.
std::vector<const ImageResult*> by_severity(const SetResult& set);

}  // namespace tumble
