#include "page/crack_marks.h"

#include "overlay/crack_sketch.h"

#include <cstdint>
#include <vector>

namespace tumble {

ArrayStore::Json make_crack_marks(const SceneDescription& scene, ArrayStore& arrays) {
    constexpr int bits = 20;  // of a mantissa: a micrometer of a meter
    const std::vector<CrackSketch> sketches = sketch_cracks(scene);
    if (sketches.empty()) return {};
    std::vector<std::int64_t> bodies, counts;  // three bodies of each: the whole, and the pieces on both sides
    std::vector<double> columns[3], places;
    for (const CrackSketch& crack : sketches) {
        for (const std::size_t body : {crack.whole, crack.a, crack.b}) bodies.push_back(std::int64_t(body));
        counts.push_back(std::int64_t(crack.outline.size()));
        for (const Vec3& p : crack.outline)
            for (int k = 0; k < 3; ++k) columns[k].push_back(p[k]);
    }
    for (const std::vector<double>& column : columns) places.insert(places.end(), column.begin(), column.end());
    return {{"bodies", arrays.add(bodies)}, {"counts", arrays.add(counts)}, {"places", arrays.add(places, bits)}};
}

}  // namespace tumble
