// Qhull's facets as a Polyhedron. Qhull merges coplanar facets, which gives true polygons.
#include "core/error.h"
#include "sim/geometry/polyhedron.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace tumble {
namespace {

// Owns Qhull's state and everything that it allocates.
struct QhullRun {
    qhT state{};
    QhullRun() { qh_zero(&state, nullptr); }
    ~QhullRun() {
        qh_freeqhull(&state, qh_ALL);
        int current = 0, total = 0;
        qh_memfreeshort(&state, &current, &total);
    }
    QhullRun(const QhullRun&) = delete;
    QhullRun& operator=(const QhullRun&) = delete;
};

// Qhull writes its messages to a FILE; a library layer prints nothing, so they go to memory and into the error.
struct MessageFile {
    char* text = nullptr;
    std::size_t length = 0;
    std::FILE* file = open_memstream(&text, &length);
    ~MessageFile() {
        std::fclose(file);
        std::free(text);
    }
};

}  // namespace

Polyhedron make_hull(const std::vector<Vec3>& points, const Vec3& origin) {
    std::vector<double> coordinates;
    coordinates.reserve(3 * points.size());
    for (const Vec3& p : points) {
        const Vec3 local = p - origin;
        coordinates.insert(coordinates.end(), {local.x(), local.y(), local.z()});
    }
    MessageFile messages;
    QhullRun run;
    qhT* qh = &run.state;
    char options[] = "qhull";
    const int failed = points.size() < 4 ? 1
                                         : qh_new_qhull(qh, 3, int(points.size()), coordinates.data(), False, options,
                                                        nullptr, messages.file);
    if (failed)
        throw InputError(
            fmt::format("the convex hull of {} points has no volume (they lie in one plane)", points.size()));

    Polyhedron hull;
    std::vector<std::uint32_t> index_of(points.size(), UINT32_MAX);
    facetT* facet;
    FORALLfacets {
        Polyhedron::Face face;
        setT* loop = qh_facet3vertex(qh, facet);  // in order, counterclockwise from outside
        vertexT *vertex, **vertexp;
        FOREACHvertex_(loop) {
            const int id = qh_pointid(qh, vertex->point);
            if (index_of[std::size_t(id)] == UINT32_MAX) {
                index_of[std::size_t(id)] = std::uint32_t(hull.vertices.size());
                const double* c = coordinates.data() + 3 * id;
                hull.vertices.emplace_back(c[0], c[1], c[2]);
            }
            face.vertices.push_back(index_of[std::size_t(id)]);
        }
        qh_settempfree(qh, &loop);
        hull.faces.push_back(std::move(face));
    }
    hull.complete();
    // Qhull's orientation varies; outward is away from a point inside.
    Vec3 inside = Vec3::Zero();
    for (const Vec3& v : hull.vertices) inside += v;
    inside /= double(hull.vertices.size());
    if (hull.faces[0].normal.dot(inside) > hull.faces[0].offset) {
        for (auto& face : hull.faces) std::reverse(face.vertices.begin(), face.vertices.end());
        hull.complete();
    }
    return hull;
}

}  // namespace tumble
