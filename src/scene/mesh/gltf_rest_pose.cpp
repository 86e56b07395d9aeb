#include "scene/mesh/gltf_rest_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

Eigen::Vector3f vector(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

}  // namespace

Eigen::Matrix4f local_transform(const Json& node) {
    Eigen::Matrix4f result = Eigen::Matrix4f::Identity();
    if (const auto matrix = find_floats(node, "matrix", 16)) {
        for (int i = 0; i < 16; ++i) result(i % 4, i / 4) = (*matrix)[std::size_t(i)];  // column by column
        return result;
    }
    if (const auto t = find_floats(node, "translation", 3)) result.topRightCorner<3, 1>() << (*t)[0], (*t)[1], (*t)[2];
    if (const auto q = find_floats(node, "rotation", 4)) {
        const float x = (*q)[0], y = (*q)[1], z = (*q)[2], w = (*q)[3];
        Eigen::Matrix4f turn = Eigen::Matrix4f::Identity();
        turn.topLeftCorner<3, 3>() << 1.0f - 2.0f * (y * y + z * z), 2.0f * (x * y - z * w), 2.0f * (x * z + y * w),
            2.0f * (x * y + z * w), 1.0f - 2.0f * (x * x + z * z), 2.0f * (y * z - x * w), 2.0f * (x * z - y * w),
            2.0f * (y * z + x * w), 1.0f - 2.0f * (x * x + y * y);
        result = result * turn;
    }
    if (const auto s = find_floats(node, "scale", 3)) {
        Eigen::Matrix4f sized = Eigen::Matrix4f::Identity();
        sized.diagonal() << (*s)[0], (*s)[1], (*s)[2], 1.0f;
        result = result * sized;
    }
    return result;
}

void GltfRestPose::add_targets(const Json& node, const Json& primitive, Vectors& positions, Vectors& normals) {
    const Json* targets = find_member(primitive, "targets");
    if (!targets || !targets->is_array() || targets->empty()) return;
    const std::size_t count = targets->size();
    std::optional<std::vector<float>> weights = find_floats(node, "weights", count);
    if (!weights)
        weights = find_floats(require_item(document_, "meshes", require_whole(node, "mesh")), "weights", count);
    if (!weights) return;  // all zero
    for (std::size_t i = 0; i < count; ++i) {
        const float weight = (*weights)[i];
        if (weight == 0.0f) continue;
        const auto add = [&](const char* name, Vectors& values) {
            const auto accessor = find_whole((*targets)[i], name);
            if (!accessor || values.empty()) return;
            const Vectors moves = buffers_.vectors(*accessor);
            for (std::size_t v = 0; v < std::min(moves.size(), values.size()); ++v)
                for (std::size_t axis = 0; axis < 3; ++axis) values[v][axis] += weight * moves[v][axis];
        };
        add("POSITION", positions);
        add("NORMAL", normals);
    }
}

void GltfRestPose::find_worlds() {
    const Json* nodes = find_member(document_, "nodes");
    const std::size_t count = nodes && nodes->is_array() ? nodes->size() : 0;
    std::vector<std::size_t> parents(count, count);
    for (std::size_t i = 0; i < count; ++i)
        for (const std::uint64_t child : whole_numbers((*nodes)[i], "children"))
            if (child < count) parents[child] = i;
    worlds_.resize(count);
    std::vector<char> known(count, 0);
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t at = i; at < count && !known[at]; at = parents[at]) {
            open.push_back(at);
            if (open.size() > count) throw MeshError(fmt::format("has node {} twice in its tree of nodes", i));
        }
        for (; !open.empty(); open.pop_back()) {  // from the root down
            const std::size_t at = open.back(), parent = parents[at];
            worlds_[at] = local_transform((*nodes)[at]);
            if (parent < count) worlds_[at] = worlds_[parent] * worlds_[at];
            known[at] = 1;
        }
    }
}

const std::vector<Eigen::Matrix4f>& GltfRestPose::joints_of(std::uint64_t index) {
    const auto [entry, is_new] = joints_.try_emplace(index);
    if (!is_new) return entry->second;
    const Json& skin = require_item(document_, "skins", index);
    std::vector<std::array<float, 16>> inverse;
    if (const auto accessor = find_whole(skin, "inverseBindMatrices")) inverse = buffers_.matrices(*accessor);
    for (const std::uint64_t joint : whole_numbers(skin, "joints")) {
        const std::size_t number = entry->second.size();
        require_item(document_, "nodes", joint);
        if (worlds_.empty()) find_worlds();
        Eigen::Matrix4f matrix = worlds_[joint];
        if (number < inverse.size()) matrix = matrix * Eigen::Map<const Eigen::Matrix4f>(inverse[number].data());
        entry->second.push_back(matrix);
    }
    return entry->second;
}

bool GltfRestPose::skin(const Json& node, const Json& primitive, Vectors& positions, Vectors& normals) {
    const auto index = find_whole(node, "skin");
    if (!index) return false;
    const std::vector<Eigen::Matrix4f>& joints = joints_of(*index);
    const Json& attributes = primitive["attributes"];
    std::vector<Eigen::Matrix4f> blended(positions.size(), Eigen::Matrix4f::Zero());
    std::vector<float> sums(positions.size(), 0.0f);
    for (int set = 0;; ++set) {
        const auto numbers = find_whole(attributes, fmt::format("JOINTS_{}", set).c_str());
        const auto weights = find_whole(attributes, fmt::format("WEIGHTS_{}", set).c_str());
        if (!numbers || !weights) break;
        const auto n = buffers_.values(*numbers, 4), w = buffers_.values(*weights, 4);
        if (n.size() != positions.size() || w.size() != positions.size())
            throw MeshError("has a skin with other vertices than its mesh");
        for (std::size_t v = 0; v < positions.size(); ++v)
            for (std::size_t i = 0; i < 4; ++i) {
                if (w[v][i] == 0.0f) continue;
                if (!(n[v][i] >= 0.0f && n[v][i] < float(joints.size())))
                    throw MeshError(fmt::format("has a vertex of joint {} of {}", n[v][i], joints.size()));
                blended[v] += w[v][i] * joints[std::size_t(n[v][i])];
                sums[v] += w[v][i];
            }
    }
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (sums[v] == 0.0f) continue;
        const Eigen::Matrix4f matrix = blended[v] / sums[v];
        const Eigen::Vector4f moved = matrix * vector(positions[v]).homogeneous();
        positions[v] = {moved.x(), moved.y(), moved.z()};
        if (normals.empty()) continue;
        const Eigen::Vector3f turned = matrix.topLeftCorner<3, 3>() * vector(normals[v]);
        normals[v] = {turned.x(), turned.y(), turned.z()};
    }
    return true;
}

}  // namespace tumble
