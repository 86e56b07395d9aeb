#include "core/html_text.h"

#include <array>
#include <cstdint>

namespace tumble {

namespace {

constexpr std::string_view replacement = "\xef\xbf\xbd";  // U+FFFD in UTF-8

/// Bytes of the UTF-8 character at the start of the text; 0 if it is none.
std::size_t character_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    // Overlong forms, surrogates and numbers beyond U+10FFFF.
    const unsigned char second = byte(1);
    const bool bad = (first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ||
                     (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f);
    return bad ? 0 : length;
}

/// Control characters that HTML forbids, and U+FFFE and U+FFFF, which XML 1.0 forbids too.
bool is_forbidden(std::string_view character) {
    const auto byte = static_cast<unsigned char>(character[0]);
    return (byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r') || byte == 0x7f ||
           character == "\xef\xbf\xbe" || character == "\xef\xbf\xbf";
}

}  // namespace

std::string html_text(std::string_view text) {
    std::string html;
    html.reserve(text.size() + text.size() / 8);
    while (!text.empty()) {
        const std::size_t length = character_length(text);
        if (length == 0 || is_forbidden(text.substr(0, length)))
            html += replacement;
        else if (text[0] == '&')
            html += "&amp;";
        else if (text[0] == '<')
            html += "&lt;";
        else if (text[0] == '>')
            html += "&gt;";
        else if (text[0] == '"')
            html += "&quot;";
        else if (text[0] == '\'')
            html += "&#39;";
        else
            html += text.substr(0, length);
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return html;
}

std::string base64(std::span<const std::byte> bytes) {
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve(base64_length(bytes.size()));
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = bytes.size() - i < 3 ? bytes.size() - i : 3;
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < count ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += k <= count ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

std::string data_address(std::string_view media_type, std::span<const std::byte> bytes) {
    return "data:" + std::string(media_type) + ";base64," + base64(bytes);
}

namespace {

constexpr std::uint8_t no_digit = 64;

constexpr std::array<std::uint8_t, 256> make_digits() {
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::uint8_t, 256> digits{};
    digits.fill(no_digit);
    for (std::size_t i = 0; i < letters.size(); ++i) digits[std::uint8_t(letters[i])] = std::uint8_t(i);
    return digits;
}

constexpr std::array<std::uint8_t, 256> digit_values = make_digits();

}  // namespace

std::optional<std::string> decode_base64(std::string_view text) {
    for (int i = 0; i < 2 && text.ends_with('='); ++i) text.remove_suffix(1);
    if (text.size() % 4 == 1) return std::nullopt;
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int count = 0;  // number of bits in the buffer
    for (const char letter : text) {
        const std::uint8_t digit = digit_values[std::uint8_t(letter)];
        if (digit == no_digit) return std::nullopt;
        bits = bits << 6 | digit;
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes.push_back(static_cast<char>(bits >> count));
        bits &= (1u << count) - 1;
    }
    return bytes;
}

}  // namespace tumble
