// The parts of a report for one image, as HTML.
#pragma once

#include "compare/comparison.h"
#include "compare/report/report_pictures.h"

#include <string>

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

}  // namespace tumble
