#include "app/threads/trace.h"
#include "app/threads/stage_timer.h"
#include "support/folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <set>
#include <string>
#include <thread>

namespace tumble::trace_test {
namespace {

nlohmann::json read(const Trace& trace) {
    const TestFolder folder;
    trace.write(folder / "trace.json");
    return nlohmann::json::parse(std::ifstream(folder / "trace.json"));
}

TEST(Trace, HasTheWorkOfEachThreadOnARowOfItsOwn) {
    Trace trace;
    trace.add({"drawing", 2.0, 2.5, 7});
    std::thread([&] { trace.add({"drawing", 2.25, 2.75, 8}); }).join();
    trace.add({"PNG", 2.5, 2.625, 7});
    trace.add({"ffmpeg", 1.0, 3.0}, "ffmpeg");
    const nlohmann::json file = read(trace);

    std::map<int, std::string> rows;
    std::vector<nlohmann::json> spans;
    for (const auto& event : file["traceEvents"]) {
        if (event["name"] == "thread_name") rows[event["tid"]] = event["args"]["name"];
        if (event["ph"] == "X") spans.push_back(event);
    }
    ASSERT_EQ(spans.size(), 4u);
    EXPECT_EQ(rows[spans[0]["tid"]], "drawing");
    EXPECT_EQ(rows[spans[1]["tid"]], "drawing 2");
    EXPECT_EQ(rows[spans[2]["tid"]], "drawing");
    EXPECT_EQ(rows[spans[3]["tid"]], "ffmpeg");
    EXPECT_EQ(spans[0]["ts"], 1e6) << "us after the first span";
    EXPECT_EQ(spans[0]["dur"], 5e5);
    EXPECT_EQ(spans[0]["args"]["frame"], 7);
    EXPECT_FALSE(spans[3].contains("args"));
}

TEST(Trace, OfAStageHasAsMuchTimeAsItsSum) {
    Trace trace;
    StageTime stage{"simulation"};
    { const StageTimer before(stage); }
    const double untraced = stage.wall;
    stage.trace = &trace;
    for (int frame = 0; frame < 3; ++frame) const StageTimer timer(stage, frame);
    double sum = 0.0;
    std::set<int> frames;
    const nlohmann::json file = read(trace);
    for (const auto& event : file["traceEvents"])
        if (event["ph"] == "X") {
            sum += event["dur"].get<double>();
            frames.insert(event["args"]["frame"].get<int>());
        }
    EXPECT_EQ(frames, (std::set<int>{0, 1, 2}));
    EXPECT_NEAR(sum, 1e6 * (stage.wall - untraced), 0.01);
}

}  // namespace
}  // namespace tumble::trace_test
