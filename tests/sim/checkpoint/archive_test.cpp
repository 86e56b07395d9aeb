// Lists and arrays written and read at -O2, at which g++ merges functions of the archive that it takes for equal.
#include "sim/checkpoint/archive.h"

#include <gtest/gtest.h>

namespace tumble::archive_test {
namespace {

struct Node {
    std::array<std::uint32_t, 2> children;
    float least[3], most[3];
    std::array<double, 4> shares;
    std::array<std::int64_t, 5> ids;
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [children, least, most, shares, ids] = self;
        archive.any(children, ids);
        archive.keep(least, most, shares);
    }
    bool operator==(const Node&) const = default;
};

TEST(Archive, ArraysOfDifferentLengthsAndTypes) {
    std::vector<Node> nodes, read;
    for (int i = 0; i < 3; ++i) {
        const auto f = float(i);
        nodes.push_back({{{1, 2}}, {f, 2.0f, 3.0f}, {4.0f, 5.0f, f}, {0.1, 0.2, 0.3, f}, {i, 6, 7, 8, 9}});
    }
    CheckpointWriter writer;
    writer.keep(nodes);
    CheckpointReader reader(writer.bytes());
    reader.keep(read);
    EXPECT_TRUE(reader.at_end());
    EXPECT_EQ(read, nodes);
}

}  // namespace
}  // namespace tumble::archive_test
