#include "render/ambient_occlusion/body_occlusion.h"

#include "render/lightmap/occlusion_lightmap.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

constexpr int coarse_ball_tile = 4;  // texels across

// Bilinear upsampling of from x from values to to x to values with the same corners.
void stretch(const std::vector<float>& values, int from, int to, std::vector<float>& result) {
    result.resize(std::size_t(to) * std::size_t(to));
    const float step = to > 1 ? float(from - 1) / float(to - 1) : 0.0f;
    const auto at = [&](int i, int j) { return values[std::size_t(j * from + i)]; };
    for (int j = 0, k = 0; j < to; ++j)
        for (int i = 0; i < to; ++i, ++k) {
            const float s = float(i) * step, t = float(j) * step;
            const int a = std::min(int(s), from - 2), b = std::min(int(t), from - 2);
            const float u = s - float(a), v = t - float(b);
            result[std::size_t(k)] = (at(a, b) * (1.0f - u) + at(a + 1, b) * u) * (1.0f - v) +
                                     (at(a, b + 1) * (1.0f - u) + at(a + 1, b + 1) * u) * v;
        }
}

}  // namespace

void BodyOcclusion::occlude_points(const Surroundings& around, double ao_radius) {
    for (const std::size_t i : around.near) occlude(points_, around.occluders[i], float(ao_radius));
    for (const PlaneInView& plane : around.planes) occlude(points_, plane.normal, plane.height, float(ao_radius));
}

// Like face_.occlude(), but only for the texels within the occluder's AO radius: few of a large receiver.
void BodyOcclusion::occlude_part(const Occluder& occluder, const GridPoints& face, float ao_radius) {
    const Eigen::Vector3f from = occluder.center - face.corner;
    const float far = occluder.bound_radius + std::min(ao_radius, occluder.ao_radius);
    const int size = face.columns;
    const auto range = [&](const Eigen::Vector3f& step, int& first, int& count) {
        const float length = step.norm(), at = from.dot(step) / length;  // m
        first = int(std::floor(std::clamp((at - far) / length, 0.0f, float(size))));
        count = int(std::ceil(std::clamp((at + far) / length, -1.0f, float(size - 1)))) - first + 1;
    };
    int i0, j0;
    GridPoints part = face;
    range(face.across, i0, part.columns);
    range(face.along, j0, part.rows);
    if (part.columns <= 0 || part.rows <= 0) return;
    part.corner = face.corner + face.across * float(i0) + face.along * float(j0);
    part_.set(part);
    part_.occlude(occluder, ao_radius);
    const float* share = part_.open().data();
    for (int j = j0; j < j0 + part.rows; ++j)
        for (int i = i0; i < i0 + part.columns; ++i) face_.open()[std::size_t(j * size + i)] *= *share++;
}

std::uint8_t BodyOcclusion::make_box(const Receiver& body, std::uint8_t faces, const Store& store) {
    const RenderBody& proxy = body.proxy;
    const Surroundings& around = body.around;
    const int size = body.texels.size;
    // A body on a large receiver occludes it as far as a plane, also where the receiver is thin.
    const float own = float(proxy.ao_radius),
                ao_radius = proxy.large_receiver ? std::numeric_limits<float>::infinity() : own;
    std::uint8_t changed = 0;
    for (int face = 0; face < 6; ++face) {
        if ((faces >> face & 1) == 0) continue;
        const int axis = face / 2, a = (axis + 1) % 3, b = (axis + 2) % 3;
        const Mat3& axes = body.pose.axes;
        const Vec3 normal = (face % 2 == 0 ? -1.0 : 1.0) * axes.col(axis);
        const Vec3 middle = body.pose.center + normal * proxy.half_size[axis];
        const Vec3 u = axes.col(a) * proxy.half_size[a], v = axes.col(b) * proxy.half_size[b];
        const Eigen::Vector3f at = middle.cast<float>(), outward = normal.cast<float>();
        const GridPoints points{(middle - u - v).cast<float>(),
                                (2.0 * u / (size - 1)).cast<float>(),
                                (2.0 * v / (size - 1)).cast<float>(),
                                outward,
                                size,
                                size};
        face_.set(points);
        if (body.lod > 0.0f) {
            for (const std::size_t i : around.near) {
                if (proxy.large_receiver)
                    occlude_part(around.occluders[i], points, ao_radius);
                else
                    face_.occlude(around.occluders[i], ao_radius);
            }
            for (const PlaneInView& plane : around.planes) face_.occlude(plane.normal, plane.height, own);
        }
        if (body.lod < 1.0f) {
            float open = 1.0f;
            for (const std::size_t i : around.near)
                open *= visibility_past(at, outward, around.occluders[i], ao_radius);
            for (const PlaneInView& plane : around.planes)
                open *= visibility_past(at, outward, plane.normal, plane.height, own);
            for (float& value : face_.open()) value = open + (value - open) * body.lod;
        }
        if (store(body.texels.x + face * size, body.texels.y, size, size, face_.open().data()))
            changed |= std::uint8_t(1u << face);
    }
    return changed;
}

bool BodyOcclusion::make_ball(const Receiver& body, const Store& store) {
    const Eigen::Matrix3f axes = body.pose.axes.cast<float>();
    const Eigen::Vector3f center = body.pose.center.cast<float>();
    const OcclusionPlace& place = body.texels;
    const auto make = [&](int size) {
        points_.clear();
        for (int j = 0; j < size; ++j)
            for (int i = 0; i < size; ++i) {
                const float s = 2.0f * float(i) / float(size - 1) - 1.0f, t = 2.0f * float(j) / float(size - 1) - 1.0f;
                const Eigen::Vector3f normal = axes * octahedral(s, t);
                points_.add(center + normal * float(body.proxy.half_size.x()), normal);
            }
        occlude_points(body.around, body.proxy.ao_radius);
    };
    if (body.lod < 1.0f) {
        make(coarse_ball_tile);
        stretch(points_.open, coarse_ball_tile, place.size, stretched_);
    }
    if (body.lod > 0.0f)
        make(place.size);
    else
        points_.open = stretched_;
    if (body.lod < 1.0f)
        for (std::size_t i = 0; i < stretched_.size(); ++i)
            points_.open[i] = stretched_[i] + (points_.open[i] - stretched_[i]) * body.lod;
    return store(place.x, place.y, place.size, place.size, points_.open.data());
}

// A run of texels, row after row over the whole width of the atlas.
bool BodyOcclusion::make_mesh(const Receiver& body, const Store& store) {
    const OcclusionPlace& place = body.texels;
    const RenderMesh& mesh = scene_->meshes[body.proxy.mesh];
    const auto make = [&](const auto& vertex_samples) {
        points_.clear();
        for (const VertexSample& sample : vertex_samples)
            points_.add((body.pose.origin + body.pose.axes * sample.position).cast<float>(),
                        (body.pose.axes * sample.normal).cast<float>());
        occlude_points(body.around, body.proxy.ao_radius);
    };
    if (body.lod < 1.0f) {
        make(mesh.coarse_samples);
        coarse_ = points_.open;
    }
    if (body.lod > 0.0f)
        make(mesh.vertex_samples);
    else
        points_.open.assign(mesh.vertex_samples.size(), 1.0f);
    if (body.lod < 1.0f)
        for (std::size_t i = 0; i < points_.open.size(); ++i) {
            const float open = coarse_[mesh.coarse_of_sample[i]];
            points_.open[i] = open + (points_.open[i] - open) * body.lod;
        }
    constexpr int width = OcclusionAtlas::width;
    const int count = int(points_.open.size()), whole = count / width;
    bool changed = whole > 0 && store(place.x, place.y, width, whole, points_.open.data());
    if (count > whole * width &&
        store(place.x, place.y + whole, count - whole * width, 1, &points_.open[std::size_t(whole * width)]))
        changed = true;
    return changed;
}

}  // namespace tumble
