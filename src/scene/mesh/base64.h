// Base64 (RFC 4648): the bytes of data: URIs.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tumble {

/// Empty for text that is not base64. Padding is optional.
std::optional<std::string> decode_base64(std::string_view text);

}  // namespace tumble
