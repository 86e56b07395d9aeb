#include "sim/contact/contact_islands.h"

namespace tumble {
namespace {

constexpr std::uint32_t none = UINT32_MAX;

bool takes_part(const Body& body) { return body.dynamic() && !body.asleep && !body.flying; }
bool rests_aside(const Body& body) { return body.dynamic() && (body.asleep || body.flying); }

struct Roles {
    bool a, b;   // whether they take part
    Roles(const Manifold& m, const std::vector<Body>& bodies) : a(takes_part(bodies[m.a])), b(takes_part(bodies[m.b])) {
        // What sleeps or flies is not held by this step's contacts.
        if (rests_aside(bodies[m.a]) || rests_aside(bodies[m.b])) a = b = false;
    }
};

}  // namespace

ContactIslands::ContactIslands(std::size_t bodies) : parent_(bodies), island_(bodies), touched_(bodies, 0) {}

// Union-find with path halving; the lower index is the root.
std::uint32_t ContactIslands::root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
}

void ContactIslands::touch(std::uint32_t i) {
    if (touched_[i] == round_) return;
    touched_[i] = round_;
    parent_[i] = i;
    island_[i] = none;
}

void ContactIslands::find(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies,
                          std::span<const std::uint32_t> awake) {
    ++round_;
    for (const Manifold& m : manifolds) {
        const auto [a, b] = Roles(m, bodies);
        if (a) touch(m.a);
        if (b) touch(m.b);
        if (!a || !b) continue;
        const std::uint32_t i = root(m.a), j = root(m.b);
        if (i < j) parent_[j] = i;
        else parent_[i] = j;
    }
    // Number the islands by their lowest body, count, then deal out.
    first_body_.assign(1, 0);
    first_manifold_.assign(1, 0);
    for (const std::uint32_t i : awake) {
        if (touched_[i] != round_) continue;
        std::uint32_t& number = island_[root(i)];
        if (number == none) {
            number = std::uint32_t(first_body_.size() - 1);
            first_body_.push_back(0);
            first_manifold_.push_back(0);
        }
        island_[i] = number;
        ++first_body_[number + 1];
    }
    const auto island_of = [&](const Manifold& m) {
        const auto [a, b] = Roles(m, bodies);
        return a ? island_[m.a] : b ? island_[m.b] : none;
    };
    for (const Manifold& m : manifolds)
        if (const std::uint32_t number = island_of(m); number != none) ++first_manifold_[number + 1];
    for (std::size_t k = 1; k < first_body_.size(); ++k) {
        first_body_[k] += first_body_[k - 1];
        first_manifold_[k] += first_manifold_[k - 1];
    }
    bodies_.resize(first_body_.back());
    manifolds_.resize(first_manifold_.back());
    std::vector<std::uint32_t> next_body = first_body_, next_manifold = first_manifold_;
    for (const std::uint32_t i : awake)
        if (touched_[i] == round_) bodies_[next_body[island_[i]]++] = i;
    for (std::uint32_t k = 0; k < manifolds.size(); ++k)
        if (const std::uint32_t number = island_of(manifolds[k]); number != none) manifolds_[next_manifold[number]++] = k;
}

}  // namespace tumble
