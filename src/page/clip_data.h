// The data of a page: one or several runs as compressed bytes, which decode_clip() of web/src/data reads.
//
//     PageClip clip{scene.title, "Tumble 0.1.0", {{"ball.toml", text}}, {}};
//     clip.runs.push_back(record_run(scene, {.threads = 2}, interrupt));   // app/page/record_run.h
//     const ClipData data = make_clip_data(clip);
//     page << base64(data.bytes);
//
// Before compression: the length of a JSON header as a 32-bit number (little endian), the header in UTF-8, and the
// arrays that it refers to (array_store.h).
#pragma once

#include "page/frame_channels.h"
#include "page/page_run.h"

#include <cstddef>
#include <string>
#include <vector>

namespace tumble {

/// A text that the clip was made from.
struct PageSource {
    std::string name;
    std::string text;
};

struct PageClip {
    std::string title;
    std::string generator;  // name and version of the program
    std::vector<PageSource> sources;
    std::vector<PageRun> runs;           // at least one
    std::size_t motion_budget = 96'000;  // bytes of a run's motion, compressed: its quanta are as fine as that allows
};

struct ClipData {
    std::vector<std::byte> bytes;
    MotionErrors errors;  // largest deviations of all runs from the simulation at the frames
};

/// The header and the arrays.
ClipData make_clip_container(const PageClip& clip);
/// The same by raw deflate, as pages have it.
ClipData make_clip_data(const PageClip& clip);

}  // namespace tumble
