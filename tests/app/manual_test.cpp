// Texts for manual pages and completions, from those of the help.
#include "app/manual/completion.h"
#include "app/manual/help_footer.h"
#include "app/manual/man_page.h"
#include "app/manual/roff.h"
#include "app/manual/value_hint.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tumble::manual_test {
namespace {

using namespace tumble::manual;
using Words = std::vector<std::string>;

TEST(ValueHint, ChoicesAreTheNamesInLowerCase) {
    const ValueHint hint = ValueHint::of("draft|normal|best [normal]", "Quality of the clip. draft: fast");
    EXPECT_EQ(hint.words, (Words{"draft", "normal", "best"}));
    EXPECT_FALSE(hint.word_list || hint.files || hint.folders);
    EXPECT_EQ(ValueHint::of("single|ghost|side-by-side", "").words.back(), "side-by-side");
}

TEST(ValueHint, FilesHaveTheEndingsOfTheNameAndOfTheHelp) {
    EXPECT_EQ(ValueHint::of("D.png", "Write a picture of 0.5 levels.").endings, (Words{"png"}));
    EXPECT_EQ(ValueHint::of("C.csv", "CSV or .npz: one row per frame").endings, (Words{"csv", "npz"}));
    EXPECT_EQ(ValueHint::of("CLIP", "The clip: .mp4 .mov\n.mkv (H.264),\n.webm or .gif. Without this none.").endings,
              (Words{"mp4", "mov", "mkv", "webm", "gif"}));
    EXPECT_EQ(ValueHint::of("R.html", "See docs/how-to/reports.md").endings, (Words{"html"}));
    EXPECT_EQ(ValueHint::of("SCENE", "The scene file (TOML)").endings, (Words{"toml"}));
    EXPECT_EQ(ValueHint::of("SUITE", "The suite (TOML; docs/reference/suite.md)").endings, (Words{"toml"}));
    EXPECT_TRUE(ValueHint::of("B", "A picture, or a scene (TOML)").empty());
    const ValueHint any = ValueHint::of("FILE", "A file");
    EXPECT_TRUE(any.files && any.endings.empty());
}

TEST(ValueHint, AlternativesAreWordsAndFiles) {
    const ValueHint hint = ValueHint::of("stepped|exact|I.csv", "Or a table, as CSV or .npz");
    EXPECT_EQ(hint.words, (Words{"stepped", "exact"}));
    EXPECT_EQ(hint.endings, (Words{"csv", "npz"}));
}

TEST(ValueHint, AListHasTheWordsOfTheHelp) {
    const ValueHint hint = ValueHint::of("LIST", "Overlays: none, or a list out of\ncontacts,\nangular-momentum,mode");
    EXPECT_TRUE(hint.word_list);
    EXPECT_EQ(hint.words, (Words{"none", "contacts", "angular-momentum", "mode"}));
    EXPECT_EQ(ValueHint::of("LIST", "a list out of depth,normal, as DIR/a.npz").words, (Words{"depth", "normal"}));
}

TEST(ValueHint, NumbersAndTextsOfferNothing) {
    for (const char* name : {"N [3]", "WxH", "S", "PATH=VALUE", "NAME", "TEXT [Lessons]", "", "LIST"})
        EXPECT_TRUE(ValueHint::of(name, "Seconds. 0.25 is slow").empty()) << name;
    EXPECT_TRUE(ValueHint::of("DIR", "").folders);
}

TEST(HelpFooter, ExamplesEndWithTheirIndentation) {
    const HelpFooter parts = read_footer("A note\nExamples:\n  tumble a\n  tumble b\nAnother note");
    EXPECT_EQ(parts.examples, (Words{"  tumble a", "  tumble b"}));
    EXPECT_EQ(parts.notes, (Words{"A note", "Another note"}));
}

TEST(HelpFooter, ExitCodesOfASentence) {
    using Codes = std::vector<ExitCode>;
    EXPECT_EQ(
        exit_codes_in("Exit codes: 0 done, 1 failed while running (or interrupted, or not), 2 wrong usage\nor bad "
                      "input. Messages go to 3 places."),
        (Codes{{0, "done"}, {1, "failed while running (or interrupted, or not)"}, {2, "wrong usage or bad input"}}));
    EXPECT_EQ(exit_codes_in("Compare two pictures: exit code 0 alike, 1 different, 2 cannot compare"),
              (Codes{{0, "alike"}, {1, "different"}, {2, "cannot compare"}}));
    EXPECT_TRUE(exit_codes_in("Describe a scene").empty());
    EXPECT_TRUE(exit_codes_in("The exit code says more").empty());
}

TEST(Roff, TextIsNoMarkup) {
    EXPECT_EQ(roff(".TH \\fB"), "\\&.TH \\efB");
    EXPECT_EQ(roff("'quoted"), "\\(aqquoted");
    EXPECT_EQ(roff("a,b, c"), "a,\\:b, c");
    EXPECT_EQ(roff_paragraphs({"a", "  b", "c"}), "a\n.nf\n  b\n.fi\nc\n");
}

/// A program with a command in a command, and texts that the markups could take for their own.
CommandText strange_program() {
    CommandText inner{"inner", "Do [it]: \"now\" 'n' $HOME `id`", "Exit codes: 0 good, 3 gone.", {}, {}, {}};
    inner.options.push_back(
        {{"-x", "--extra"}, "a|b", "It's [odd]: \\$(id)", true, false, {}, ValueHint::of("a|b", "")});
    inner.arguments.push_back({{"in"}, "IN.txt", "Input", true, true, {}, ValueHint::of("IN.txt", "")});
    CommandText outer{"outer", "Outer", "", {}, {}, {inner}};
    return {"tool", "Tool: does things", "Exit codes: 0 done, 1 failed.", {}, {}, {outer}};
}

TEST(ManPage, ACommandInACommandIsAPartOfItsPage) {
    const std::vector<ManPage> pages = man_pages(strange_program(), "1.2");
    ASSERT_EQ(pages.size(), 2U);
    EXPECT_EQ(pages[1].file, "tool-outer.1");
    for (const char* part :
         {".SS tool outer inner", "\\fB1\\fR\nfailed.\n.PP\nOf \\fBtool outer inner\\fR:\n.TP\n\\fB0\\fR\ngood.\n",
          "[\\fIOPTIONS\\fR] \\fB\\-x\\fR \\fIa|b\\fR", "\\e$(id)", "\\fB3\\fR\ngone.", "Required.\n"})
        EXPECT_NE(pages[1].text.find(part), std::string::npos) << part << '\n' << pages[1].text;
    EXPECT_NE(pages[0].text.find("\\fB1\\fR\nfailed.\n"), std::string::npos);
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
