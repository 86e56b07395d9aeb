// No foreign text controls or fills a terminal.
#include "core/safe_text.h"
#include "core/error.h"

#include <gtest/gtest.h>

#include <string>

namespace tumble::safe_text_test {
namespace {

using namespace std::string_literals;

TEST(SafeText, ReadableTextIsUnchanged) {
    for (const std::string text : {"", "crate 7", "C:\\crate", "Kiste grün", "木箱", "🎲", "a\u200db", "100 %", "'\"`$"})
        EXPECT_EQ(safe_text(text), text);
}

TEST(SafeText, ControlsAreShownAsEscapes) {
    EXPECT_EQ(safe_text("a\x1b[31mb"), "a\\x1b[31mb");
    EXPECT_EQ(safe_text("one\ntwo\tthree\r"), "one\\ntwo\\tthree\\r");
    EXPECT_EQ(safe_text("a\0b\x07\x7f"s), "a\\x00b\\x07\\x7f");
    EXPECT_EQ(safe_text("a\u0085b\u009b2Jc"), "a\\u0085b\\u009b2Jc") << "C1: 9b begins a command as ESC [ does";
    EXPECT_EQ(safe_text("a\u202egnp.exe\u2066\u200f"), "a\\u202egnp.exe\\u2066\\u200f") << "the direction of reading";
    EXPECT_EQ(safe_text("a\u2028b\ufeff\u200b"), "a\\u2028b\\ufeff\\u200b");
    EXPECT_EQ(safe_text("a\U000e0041"), "a\\U000e0041") << "a tag, invisible";
}

TEST(SafeText, InvalidUtf8IsShownByteByByte) {
    EXPECT_EQ(safe_text("a\xff\x80"s), "a\\xff\\x80");
    EXPECT_EQ(safe_text("\xc3"s), "\\xc3") << "cut short";
    EXPECT_EQ(safe_text("\xc0\x9b\xe0\x82\x9b"s), "\\xc0\\x9b\\xe0\\x82\\x9b") << "overlong forms of a control";
    EXPECT_EQ(safe_text("\xed\xa0\x80"s), "\\xed\\xa0\\x80") << "a surrogate";
    EXPECT_EQ(safe_text("\xf4\x90\x80\x80\xf8"s), "\\xf4\\x90\\x80\\x80\\xf8") << "beyond the last character";
}

// Each byte, and each character: the result has no control character in any encoding of a terminal.
TEST(SafeText, NothingUnsafeIsLeft) {
    std::string all;
    for (int byte = 0; byte < 256; ++byte) all += char(byte);
    for (int lead = 0xc2; lead < 0xe0; ++lead)
        for (int next = 0x80; next < 0xc0; ++next) all += {char(lead), char(next)};
    const std::string safe = safe_text(all, 1 << 20);
    for (std::size_t i = 0; i < safe.size(); ++i) {
        const auto byte = static_cast<unsigned char>(safe[i]);
        EXPECT_TRUE(byte >= 0x20 && byte != 0x7f) << i;
        const bool is_c1 = byte == 0xc2 && static_cast<unsigned char>(safe[i + 1]) < 0xa0;
        EXPECT_FALSE(is_c1) << i;
    }
}

TEST(SafeText, LongTextIsCutAndItsLengthIsGiven) {
    const std::string text(10'000'000, 'k');
    const std::string safe = safe_text(text);
    EXPECT_EQ(safe.size(), value_text_bytes);
    EXPECT_EQ(safe.substr(safe.size() - 22), "kk... (10000000 bytes)");
    EXPECT_EQ(safe_text(std::string(value_text_bytes, 'k')), std::string(value_text_bytes, 'k')) << "just fits";
    std::string wide;
    for (int i = 0; i < 1000; ++i) wide += "箱";
    const std::string cut = safe_text(wide);
    EXPECT_LE(cut.size(), value_text_bytes);
    EXPECT_EQ(safe_text(cut), cut) << "after a whole character";
    EXPECT_NE(cut.find("箱... (3000 bytes)"), std::string::npos);
    EXPECT_LE(safe_text(std::string(1000, '\x1b')).size(), value_text_bytes) << "the length includes the escapes";
}

TEST(SafeText, TwiceIsOnce) {
    for (const std::string& text : {"a\x1b\n\u202e\xff"s, std::string(5000, '\n'), std::string(5000, 'x')}) {
        const std::string once = safe_text(text);
        EXPECT_EQ(safe_text(once), once);
    }
}

TEST(SafeText, LinesMayStay) {
    EXPECT_EQ(safe_lines("a\n\tb\x1b\r\n"), "a\n\tb\\x1b\\r\n");
    EXPECT_EQ(safe_path("new\nline.toml"), "new\\nline.toml");
    EXPECT_EQ(safe_path(std::string(4096, 'p')).size(), 4096u);
}

TEST(SafeText, EveryErrorIsSafe) {
    EXPECT_STREQ(InputError("no \x1b[2J").what(), "error: no \\x1b[2J");
    EXPECT_STREQ(InputError({"a\x1b\n.toml", 3, 7}, "bad\nline").what(), "a\\x1b\\n.toml:3:7: error: bad\\nline");
    EXPECT_STREQ(RunError("ffmpeg failed:\nUnknown \x1b[31mencoder").what(),
                 "error: ffmpeg failed:\nUnknown \\x1b[31mencoder")
        << "another program's lines stay lines";
    EXPECT_LT(std::string(InputError(std::string(10'000'000, 'k')).what()).size(), message_text_bytes + 10);
    EXPECT_LT(std::string(RunError(std::string(10'000'000, 'k')).what()).size(), message_text_bytes + 10);
}

}  // namespace
}  // namespace tumble::safe_text_test
