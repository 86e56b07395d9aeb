#include "sim/contact/islands.h"

#include <numeric>

namespace tumble {
namespace {

// Union-find with path halving; the lower index is the root, so that roots ascend.
struct Forest {
    std::vector<std::uint32_t> parent;
    explicit Forest(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0u); }
    std::uint32_t root(std::uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    }
    void join(std::uint32_t i, std::uint32_t j) {
        i = root(i);
        j = root(j);
        if (i < j) parent[j] = i;
        else parent[i] = j;
    }
};

}  // namespace

std::vector<Island> find_islands(const std::vector<Contact>& contacts, const std::vector<Body>& bodies) {
    constexpr std::uint32_t none = UINT32_MAX;
    Forest forest(bodies.size());
    std::vector<bool> touched(bodies.size(), false);
    for (const Contact& c : contacts) {
        if (bodies[c.a].dynamic()) touched[c.a] = true;
        if (bodies[c.b].dynamic()) touched[c.b] = true;
        if (bodies[c.a].dynamic() && bodies[c.b].dynamic()) forest.join(c.a, c.b);
    }
    std::vector<Island> islands;
    std::vector<std::uint32_t> island_of(bodies.size(), none);
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        if (!touched[i]) continue;
        std::uint32_t& index = island_of[forest.root(i)];
        if (index == none) {
            index = std::uint32_t(islands.size());
            islands.emplace_back();
        }
        islands[index].bodies.push_back(i);
    }
    for (std::uint32_t k = 0; k < contacts.size(); ++k) {
        const std::uint32_t i = bodies[contacts[k].a].dynamic() ? contacts[k].a : contacts[k].b;
        islands[island_of[forest.root(i)]].contacts.push_back(k);
    }
    return islands;
}

}  // namespace tumble
