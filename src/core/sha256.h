// SHA-256 (FIPS 180-4): names content by a number that no other content has.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace tumble {

class Sha256 {
public:
    Sha256();
    ~Sha256();
    Sha256(const Sha256&) = delete;
    Sha256& operator=(const Sha256&) = delete;

    void add(std::span<const std::byte> data);
    void add(std::string_view text) { add(std::as_bytes(std::span(text))); }

    /// The hash of all that was added, 64 lower-case hexadecimal digits. Nothing may be added after it.
    std::string finish();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The hash of one text.
std::string sha256(std::string_view text);

}  // namespace tumble
