// The comparison of many pairs at a time.
#pragma once

#include "compare/comparison.h"
#include "compare/pair_compare.h"
#include "compare/tolerances.h"

#include <functional>
#include <optional>
#include <vector>

namespace tumble {

/// The next pair, or nothing at the end. Called by one thread at a time.
using PairSource = std::function<std::optional<ImagePair>()>;

/// Called with each result by the thread that found it: in no order, and several at a time.
using PairSink = std::function<void(const ImagePair&, ImageResult&)>;

/// Compares the pairs with `workers` threads; the results are in the order of the pairs. As many pairs are in memory as
/// there are workers. Throws the first error of the source, of a comparison or of the sink.
std::vector<ImageResult> compare_pairs(const PairSource& next, const Tolerances& tolerances, int workers,
                                       const PairSink& found = {});

}  // namespace tumble
