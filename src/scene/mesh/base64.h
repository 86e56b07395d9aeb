// Base64 (RFC 4648): the bytes of data: URIs.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tumble {

/// Nothing when the text is none. Padding may be left out.
std::optional<std::string> decode_base64(std::string_view text);

}  // namespace tumble
