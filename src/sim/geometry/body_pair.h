// Two bodies by their indices, the lower one first.
#pragma once

#include <compare>
#include <cstdint>

namespace tumble {

struct BodyPair {
    std::uint32_t a, b;  // a < b
    friend bool operator==(const BodyPair&, const BodyPair&) = default;
    friend auto operator<=>(const BodyPair& l, const BodyPair& r) { return l.key() <=> r.key(); }
    std::uint64_t key() const {
        return std::uint64_t(a) << 32 | b;
    }  // compared in one operation: lists of pairs are sorted by it
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [a, b] = self;
        archive.body(a, b);
    }
};

}  // namespace tumble
