// Spatial vectors and inertias (Featherstone 2008, Rigid Body Dynamics Algorithms, chapter 2): a rigid motion or a
// system of forces as six numbers about one point, in world axes. The point of a link is its own joint, so that no
// digits are lost in long chains, and a change of the point is a shift.
#pragma once

#include "core/vector.h"

namespace tumble {

/// Velocity or acceleration of a rigid body: of its rotation, and of its point at the reference. Accelerations are
/// those of the material point, not Featherstone's: f = I a + b then has b = (w x I_P w; m w x (w x c)).
struct SpatialMotion {
    Vec3 turn = Vec3::Zero();  // rad/s, or rad/s^2
    Vec3 move = Vec3::Zero();  // m/s, or m/s^2
};

struct SpatialForce {
    Vec3 moment = Vec3::Zero();  // N m, about the reference
    Vec3 force = Vec3::Zero();   // N
    SpatialForce& operator+=(const SpatialForce& f) {
        moment += f.moment;
        force += f.force;
        return *this;
    }
};

/// The same force about another point: `r` (m) from that point to the present one.
inline SpatialForce shifted(const SpatialForce& f, const Vec3& r) { return {f.moment + r.cross(f.force), f.force}; }

/// A symmetric matrix.
struct Sym3 {
    double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;

    Vec3 operator*(const Vec3& v) const {
        return {xx * v[0] + xy * v[1] + xz * v[2], xy * v[0] + yy * v[1] + yz * v[2],
                xz * v[0] + yz * v[1] + zz * v[2]};
    }
    Vec3 col(int i) const {
        if (i == 0) return {xx, xy, xz};
        return i == 1 ? Vec3(xy, yy, yz) : Vec3(xz, yz, zz);
    }
    Sym3& operator+=(const Sym3& s) {
        xx += s.xx;
        xy += s.xy;
        xz += s.xz;
        yy += s.yy;
        yz += s.yz;
        zz += s.zz;
        return *this;
    }
    /// Adds k v v^T.
    void add_outer(double k, const Vec3& v) {
        const double x = k * v[0], y = k * v[1], z = k * v[2];
        xx += x * v[0];
        xy += x * v[1];
        xz += x * v[2];
        yy += y * v[1];
        yz += y * v[2];
        zz += z * v[2];
    }
    /// The same in the axes that columns of r are rotated from: r S r^T.
    Sym3 turned(const Mat3& r) const {
        Vec3 rows[3];  // of r S
        for (int i = 0; i < 3; ++i) rows[i] = *this * Vec3(r.row(i));
        const auto at = [&](int i, int j) { return rows[i].dot(r.row(j)); };
        return {at(0, 0), at(0, 1), at(0, 2), at(1, 1), at(1, 2), at(2, 2)};
    }
    Mat3 full() const {
        Mat3 m;
        m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
        return m;
    }
    /// The inverse of a positive definite matrix, by cofactors.
    Sym3 inverse() const {
        const double a = yy * zz - yz * yz, b = xz * yz - xy * zz, c = xy * yz - xz * yy;
        const double k = 1.0 / (xx * a + xy * b + xz * c);
        return {k * a, k * b, k * c, k * (xx * zz - xz * xz), k * (xy * xz - xx * yz), k * (xx * yy - xy * xy)};
    }
};

/// The symmetric part of a matrix that is symmetric but for rounding.
inline Sym3 symmetric(const Mat3& m) { return {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)}; }

/// f = I a: moment = turning turn + mixed move, force = mixed^T turn + moving move. Of a rigid body or of a subtree
/// (Featherstone's articulated-body inertia, section 7.1).
struct SpatialInertia {
    Sym3 turning;               // kg m^2
    Mat3 mixed = Mat3::Zero();  // kg m
    Sym3 moving;                // kg

    SpatialForce operator*(const SpatialMotion& a) const {
        return {turning * a.turn + mixed * a.move, mixed.transpose() * a.turn + moving * a.move};
    }
    SpatialInertia& operator+=(const SpatialInertia& i) {
        turning += i.turning;
        mixed += i.mixed;
        moving += i.moving;
        return *this;
    }
    /// Subtracts pivot u u^T.
    void subtract_outer(const SpatialForce& u, double pivot) {
        turning.add_outer(-pivot, u.moment);
        const Vec3 k = pivot * u.force;
        for (int j = 0; j < 3; ++j) mixed.col(j) -= k[j] * u.moment;
        moving.add_outer(-pivot, u.force);
    }
    /// Adds another one about the point of this one: `r` (m) from this point to that of the other.
    /// mixed' = mixed + r* moving, turning' = turning + r* mixed^T + (r* mixed^T)^T + r* moving r*^T.
    void add_shifted(const SpatialInertia& i, const Vec3& r) {
        Mat3 k;
        for (int c = 0; c < 3; ++c) k.col(c) = r.cross(Vec3(i.mixed.row(c)));
        turning.xx += i.turning.xx + 2.0 * k(0, 0);
        turning.xy += i.turning.xy + (k(0, 1) + k(1, 0));
        turning.xz += i.turning.xz + (k(0, 2) + k(2, 0));
        turning.yy += i.turning.yy + 2.0 * k(1, 1);
        turning.yz += i.turning.yz + (k(1, 2) + k(2, 1));
        turning.zz += i.turning.zz + 2.0 * k(2, 2);
        mixed += i.mixed;
        add_moving(i.moving, r);
    }
    /// The same for an inertia that has `moving` alone.
    void add_moving(const Sym3& m, const Vec3& r) {
        Mat3 n;
        for (int c = 0; c < 3; ++c) n.col(c) = r.cross(m.col(c));
        const Vec3 x = r.cross(Vec3(n.row(0))), y = r.cross(Vec3(n.row(1)));
        turning.xx += x[0];
        turning.xy += x[1];
        turning.xz += x[2];
        turning.yy += y[1];
        turning.yz += y[2];
        turning.zz += r[0] * n(2, 1) - r[1] * n(2, 0);
        mixed += n;
        moving += m;
    }
};

}  // namespace tumble
