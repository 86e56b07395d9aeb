// The fifteen candidate separating axes of two boxes (Gottschalk, Lin and Manocha 1996, "OBBTree", section 5): three
// face normals of each box and the cross products of an edge of A with an edge of B. Three axes are computed side by
// side; each has the arithmetic of one axis alone.
#pragma once

#include "sim/geometry/collider.h"
#include "sim/geometry/settings.h"

#include <cmath>
#include <limits>

namespace tumble {

class BoxAxes {
public:
    // Three numbers in two registers that every x86-64 has.
    class Lanes {
    public:
        Lanes() = default;
        Lanes(double x, double y, double z) : low_{x, y}, high_{z, 0.0} {}
        template <class Vector>
        explicit Lanes(const Vector& v) : Lanes(v[0], v[1], v[2]) {}

        double operator[](int k) const { return k < 2 ? low_[k] : high_[0]; }
        friend Lanes operator+(const Lanes& l, const Lanes& r) { return {l.low_ + r.low_, l.high_ + r.high_}; }
        friend Lanes operator-(const Lanes& l, const Lanes& r) { return {l.low_ - r.low_, l.high_ - r.high_}; }
        friend Lanes operator*(const Lanes& l, const Lanes& r) { return {l.low_ * r.low_, l.high_ * r.high_}; }
        friend Lanes operator*(double l, const Lanes& r) { return {l * r.low_, l * r.high_}; }
        Lanes abs() const { return {Two(Bits(low_) & INT64_MAX), Two(Bits(high_) & INT64_MAX)}; }
        // Rotation of the three lanes by one, forwards and backwards.
        Lanes next() const { return {low_[1], high_[0], low_[0]}; }
        Lanes before() const { return {high_[0], low_[0], low_[1]}; }

    private:
        typedef double Two __attribute__((vector_size(16)));
        typedef std::int64_t Bits __attribute__((vector_size(16)));
        Lanes(Two low, Two high) : low_(low), high_(high) {}
        Two low_, high_;
    };

    /// Half extents (m) and poses.
    BoxAxes(const Vec3& half_a, const Pose& pose_a, const Vec3& half_b, const Pose& pose_b)
        : r(pose_a.rotation.transpose() * pose_b.rotation), a_(half_a), b_(half_b) {
        const Vec3 between = pose_b.position - pose_a.position;
        t = pose_a.rotation.transpose() * between;
        t_in_b = pose_b.rotation.transpose() * between;
        for (int k = 0; k < 3; ++k) {
            row_[k] = Lanes(r.row(k));
            size_[k] = row_[k].abs();
        }
    }

    Vec3 t, t_in_b;  // m: B's center in A's frame; A's center in B's frame, negated
    Mat3 r;          // rotation from B's frame to A's frame

    /// Separations (m) along the face normals.
    Lanes faces_a() const {
        return Lanes(t).abs() - Lanes(a_) -
               (b_[0] * Lanes(r.col(0)).abs() + b_[1] * Lanes(r.col(1)).abs() + b_[2] * Lanes(r.col(2)).abs());
    }
    Lanes faces_b() const {
        return Lanes(t_in_b).abs() - Lanes(b_) - (a_[0] * size_[0] + a_[1] * size_[1] + a_[2] * size_[2]);
    }

    /// Along A's axis i x B's axes: separations not yet divided by the lengths of the axes, the squares of these
    /// lengths, and the offset of B's center along them.
    struct Edges {
        Lanes separation, square, across;
    };
    Edges edges(int i) const {
        const int i1 = i == 2 ? 0 : i + 1, i2 = i == 0 ? 2 : i - 1;
        const Lanes across = t[i2] * row_[i1] - t[i1] * row_[i2], b(b_);
        const Lanes reach =
            a_[i1] * size_[i2] + a_[i2] * size_[i1] + b.next() * size_[i].before() + b.before() * size_[i].next();
        return {across.abs() - reach, row_[i1] * row_[i1] + row_[i2] * row_[i2], across};
    }

    /// Separation along A's edge x B's edge; the lowest number for parallel edges.
    static double separation(const Edges& e, int j) {
        return e.square[j] < tuning::parallel_edges ? lowest : e.separation[j] / std::sqrt(e.square[j]);
    }
    /// Axis index: the faces of A, then those of B, then the edge pair i, j as 6 + 3 i + j.
    double along(std::uint32_t axis) const {
        if (axis < 3) return faces_a()[int(axis)];
        return axis < 6 ? faces_b()[int(axis) - 3] : separation(edges(int(axis - 6) / 3), int(axis - 6) % 3);
    }

    static constexpr double lowest = -std::numeric_limits<double>::infinity();

private:
    const Vec3 &a_, &b_;
    Lanes row_[3], size_[3];  // rows of r; absolute values of r
};

}  // namespace tumble
