// Text in HTML and in XML 1.0.
#include "core/html_text.h"

#include <gtest/gtest.h>

#include <string>

namespace tumble::html_text_test {
namespace {

const std::string replacement = "\xef\xbf\xbd";  // U+FFFD

TEST(HtmlText, EscapesMarkup) { EXPECT_EQ(html_text("a<b>&\"'\xc3\xa9"), "a&lt;b&gt;&amp;&quot;&#39;\xc3\xa9"); }

/// XML 1.0 allows tab, line feed, carriage return, U+0020 to U+D7FF, U+E000 to U+FFFD, U+10000 to U+10FFFF.
TEST(HtmlText, HoldsOnlyCharactersOfXml) {
    for (char32_t code = 0; code <= 0x10ffff; ++code) {
        std::string text;
        const auto add = [&](char32_t byte) { text += char(static_cast<unsigned char>(byte)); };
        if (code < 0x80) {
            add(code);
        } else if (code < 0x800) {
            add(0xc0 | code >> 6);
            add(0x80 | (code & 0x3f));
        } else if (code < 0x10000) {
            add(0xe0 | code >> 12);
            add(0x80 | (code >> 6 & 0x3f));
            add(0x80 | (code & 0x3f));
        } else {
            add(0xf0 | code >> 18);
            add(0x80 | (code >> 12 & 0x3f));
            add(0x80 | (code >> 6 & 0x3f));
            add(0x80 | (code & 0x3f));
        }
        const bool allowed = code == 9 || code == 10 || code == 13 || (code >= 0x20 && code <= 0xd7ff) ||
                             (code >= 0xe000 && code <= 0xfffd) || code >= 0x10000;
        const std::string html = html_text(text);
        if (!allowed) {
            ASSERT_EQ(html.find_first_not_of(replacement), std::string::npos) << std::hex << int(code);
        } else if (code >= 0x80) {
            ASSERT_EQ(html, text) << std::hex << int(code);
        }
    }
}

TEST(HtmlText, BytesThatAreNotUtf8AreReplaced) {
    EXPECT_EQ(html_text("a\xff\xc3"), "a" + replacement + replacement);
    EXPECT_EQ(html_text(std::string("\0", 1)), replacement);
}

}  // namespace
}  // namespace tumble::html_text_test
