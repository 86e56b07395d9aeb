// Text and bytes in the form of HTML.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tumble {

/// The text with & < > " ' as character references, for content and for values in quotes. Characters that HTML or
/// XML 1.0 forbids, and bytes that are not UTF-8, become U+FFFD.
std::string html_text(std::string_view text);

/// RFC 4648, with padding.
std::string base64(std::span<const std::byte> bytes);

/// Characters of the base64 of so many bytes.
constexpr std::size_t base64_length(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

/// "data:image/png;base64,...".
std::string data_address(std::string_view media_type, std::span<const std::byte> bytes);

/// The bytes of such a text; empty for text that is not base64. Padding is optional.
std::optional<std::string> decode_base64(std::string_view text);

}  // namespace tumble
