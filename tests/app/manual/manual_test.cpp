// Manual pages, completions and JSON from the description of the commands.
#include "app/manual/manual.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace tumble::manual_test {
namespace {

using namespace tumble::manual;

/// A program with a command in a command, and texts that the markups could take for their own.
CommandText strange_program() {
    CommandText inner{"inner",
                      "Do [it]: \"now\" 'n' $HOME `id`",
                      {{0, "good"}, {3, "gone"}},
                      ".TH \\fB\n'a,b, c\n  kept",
                      "  one",
                      {},
                      {},
                      {}};
    ValueKind words, files;
    words.words = {"a", "b"};
    files.files = true;
    files.endings = {"txt"};
    inner.options.push_back({{"-x", "--extra"}, "a|b", "a", "It's [odd]: \\$(id)", true, false, {}, words});
    inner.arguments.push_back({{"in"}, "IN.txt", "", "Input", true, true, {}, files});
    CommandText outer{"outer", "Outer", {}, "", "", {}, {}, {inner}};
    return {"tool", "Tool: does things", {{0, "done"}, {1, "failed"}}, "", "", {}, {}, {outer}};
}

TEST(ManPage, ACommandInACommandIsAPartOfItsPage) {
    const std::vector<ManPage> pages = man_pages(strange_program(), "1.2");
    ASSERT_EQ(pages.size(), 2U);
    EXPECT_EQ(pages[1].file, "tool-outer.1");
    for (const char* part :
         {".SS tool outer inner", "\\fB1\\fR\nfailed.\n.PP\nOf \\fBtool outer inner\\fR:\n.TP\n\\fB0\\fR\ngood.\n",
          "[\\fIOPTIONS\\fR] \\fB\\-x\\fR \\fIa|b\\fR [a]", "\\e$(id)", "\\fB3\\fR\ngone.", "Required.\n"})
        EXPECT_NE(pages[1].text.find(part), std::string::npos) << part << '\n' << pages[1].text;
    EXPECT_NE(pages[0].text.find("\\fB1\\fR\nfailed.\n"), std::string::npos);
}

TEST(ManPage, TextIsNoMarkup) {
    const std::string text = man_pages(strange_program(), "1.2")[1].text;
    EXPECT_NE(text.find("\n\\&.TH \\efB\n\\(aqa,\\:b, c\n.nf\n  kept\n.fi\n"), std::string::npos) << text;
}

TEST(Json, HasCommandsOptionsAndValues) {
    const auto json = nlohmann::json::parse(to_json(strange_program(), "1.2"));
    EXPECT_EQ(json["version"], "1.2");
    const auto& inner = json["commands"][0]["commands"][0];
    EXPECT_EQ(inner["exit_codes"][1]["code"], 3);
    EXPECT_EQ(inner["exit_codes"][1]["meaning"], "gone");
    const auto& option = inner["options"][0];
    EXPECT_EQ(option["type"], "choice");
    EXPECT_EQ(option["choices"], (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(option["default"], "a");
    EXPECT_EQ(inner["arguments"][0]["type"], "file");
    EXPECT_EQ(inner["arguments"][0]["endings"][0], "txt");
}

TEST(Completion, NestedCommandsAreInAllScripts) {
    const CommandText program = strange_program();
    EXPECT_NE(bash_completion(program).find("'outer inner -x' | 'outer inner --extra') takes=yes words=\"a b\""),
              std::string::npos);
    EXPECT_NE(bash_completion(program).find("'outer inner @'*) takes=yes kind=files endings=\"txt\""),
              std::string::npos);
    EXPECT_NE(zsh_completion(program).find("_tool_outer_inner() {"), std::string::npos);
    EXPECT_NE(zsh_completion(program).find("It'\\''s \\[odd\\]\\: \\\\$(id)"), std::string::npos);
    EXPECT_NE(fish_completion(program).find("'It\\'s [odd]: \\\\$(id)'"), std::string::npos);
}

}  // namespace
}  // namespace tumble::manual_test
