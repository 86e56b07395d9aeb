// The pure parts of farm jobs: divisions of frames, lists of parts, words of shells and of templates.
#include "app/farm/farm_job.h"
#include "app/farm/shell_text.h"
#include "core/error.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>

namespace tumble::farm_test {
namespace {

TEST(Farm, PartsAreOfOneLengthAndCoverTheFrames) {
    for (std::int64_t frames = 1; frames < 60; ++frames)
        for (std::int64_t length = 1; length <= frames + 1; ++length) {
            std::int64_t next = 0;
            for (const FarmPart& part : divide_frames(frames, length)) {
                EXPECT_EQ(part.first, next);
                next = part.last + 1;
                EXPECT_TRUE(next == frames || part.count() == length);
            }
            EXPECT_EQ(next, frames);
        }
}

TEST(Farm, ListsOfParts) {
    EXPECT_EQ(part_list({}), "");
    EXPECT_EQ(part_list({3}), "3");
    EXPECT_EQ(part_list({3, 4}), "3-4");
    EXPECT_EQ(part_list({1, 3, 7, 8, 9, 20}), "1,3,7-9,20");
}

/// The word as a shell reads it.
std::string read_by_shell(const std::string& word) {
    std::FILE* const shell = ::popen(("printf %s. " + word).c_str(), "r");
    std::string text;
    std::array<char, 4096> part;
    while (const std::size_t count = std::fread(part.data(), 1, part.size(), shell)) text.append(part.data(), count);
    ::pclose(shell);
    if (text.empty() || text.back() != '.') return "(not one word)";
    text.pop_back();
    return text;
}

TEST(Farm, AShellReadsWordsBack) {
    std::string all;
    for (int c = 1; c < 256; ++c) all += char(c);
    for (const std::string& text :
         {all, std::string(), std::string("plain/word-1.toml"), std::string("it's"), std::string("'"),
          std::string("a\nb"), std::string("-n"), std::string("~"), std::string("--fps=10")})
        EXPECT_EQ(read_by_shell(shell_word(text)), text);
    EXPECT_EQ(shell_word("a/b.toml"), "a/b.toml");
    EXPECT_EQ(shell_array("name", {"a", "b c", "--d=1"}), "name=( a 'b c' --d=1 )");
}

FarmJob small_job() {
    FarmJob job;
    job.scenes = {"/shared/scene.toml"};
    job.clip = "clip.mp4";
    job.frames = 12;
    job.fps = 10.0;
    job.parts = divide_frames(12, 5);
    job.checkpoint_period = 0.5;
    return job;
}

TEST(Farm, ATemplateHoldsNoBracesOfOptions) {
    FarmJob job = small_job();
    EXPECT_NE(openjd_template(job, "/shared/job.json").find("\"default\": \"0-11\""), std::string::npos);
    for (const char* option : {"--set=title=\"{{Param.Scene}}\"", "--set=title=}}", "--set=title=\"a\nb\""}) {
        job.render_options = {option};
        EXPECT_THROW(openjd_template(job, "/shared/job.json"), InputError) << option;
    }
    job.render_options = {"--set=a={ b = { c = 1 } }"};
    EXPECT_NO_THROW(openjd_template(job, "/shared/job.json"));
}

}  // namespace
}  // namespace tumble::farm_test
