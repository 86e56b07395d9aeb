// `fracture`: its keys, the pieces and the bonds that a scene gets from it.
#include "scene/fracture/bonds.h"
#include "scene/fracture/convex_parts.h"
#include "scene/fracture/cut_body.h"
#include "scene/fracture/cut_pattern.h"
#include "scene/hash/scene_hash.h"
#include "scene/load.h"
#include "sim/geometry/shapes/hull.h"
#include "sim/geometry/shapes/mesh.h"
#include "sim/geometry/shapes/shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace tumble::fracture_test {
namespace {

const std::string box = "shape = { type = \"box\", size = [1, 1, 1] }\n";

SceneDescription scene_of(const std::string& body) {
    return parse_scene("format = 1\n[[body]]\nname = \"pane\"\nstrength = 1e6\n" + body, "fracture.toml");
}
SceneDescription cut(const std::string& shape, const std::string& keys) {
    return scene_of(shape + "fracture = { " + keys + " }\n");
}

std::vector<MassProperties> masses(const SceneDescription& scene) {
    std::vector<MassProperties> all;
    for (const BodyDescription& body : scene.bodies)
        if (body.piece_of) all.push_back(mass_properties(body));
    return all;
}

const TriangleMesh& mesh_of(const BodyDescription& piece) { return std::get<MeshShape>(piece.shape).asset->mesh; }

double volume(const BodyDescription& piece) { return mesh_mass(mesh_of(piece), 1.0).mass; }

FractureDescription fracture(const SceneDescription& scene) { return *scene.bodies.front().fracture; }

const std::vector<std::string> shapes = {
    box,
    "shape = { type = \"box\", size = [1.2, 0.9, 0.008] }\n",
    "shape = { type = \"box\", size = [0.1, 3, 0.1] }\n",
    "shape = { type = \"cylinder\", radius = 0.3, height = 0.8 }\n",
    "shape = { type = \"sphere\", radius = 0.5 }\n",
    "shape = { type = \"hull\", points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] }\n",
    "shape = { type = \"compound\", parts = [{ shape = { type = \"box\", size = [1, 1, 2] }, density = 70 }, { shape = "
    "{ "
    "type = \"box\", size = [1, 1, 1] }, position = [0.5, 1, 0.5], rotation = { axis = [0, 1, 0], angle = 90 } }] }\n"};
const std::vector<std::string> patterns = {"cells = 20", "cells = 24, pattern = \"radial\"",
                                           "cells = 7, pattern = \"slabs\"", "cells = 30, pattern = \"bricks\""};

TEST(Fracture, PiecesHaveTheMassAndTheInertiaOfTheWhole) {
    for (const std::string& shape : shapes)
        for (const std::string& pattern : patterns) {
            const SceneDescription scene = cut(shape, pattern);
            const MassProperties whole = mass_properties(scene.bodies.front()), sum = sum_of_masses(masses(scene));
            EXPECT_EQ(sum.mass, whole.mass) << shape << pattern;
            EXPECT_LE((sum.inertia - whole.inertia).norm(), 1e-12 * whole.inertia.norm()) << shape << pattern;
            EXPECT_LE((sum.center_of_mass - whole.center_of_mass).norm(), 1e-12) << shape << pattern;
        }
}

TEST(Fracture, PiecesOfABallAreDrawnFinerThanTheyCollide) {
    const SceneDescription scene = cut(shapes[4], "cells = 12");
    double drawn = 0.0, solid = 0.0;
    for (const BodyDescription& body : scene.bodies) {
        if (!body.piece_of) continue;
        const MeshAsset& asset = *std::get<MeshShape>(body.shape).asset;
        EXPECT_LT(asset.mesh.vertices.size(), 100u);
        TriangleMesh surface;
        for (const MeshAsset::Vertex& v : asset.vertices)
            surface.vertices.emplace_back(v.position[0], v.position[1], v.position[2]);
        for (std::size_t i = 0; i < asset.indices.size(); i += 3)
            surface.triangles.push_back({asset.indices[i], asset.indices[i + 1], asset.indices[i + 2]});
        drawn += mesh_mass(surface, 1.0).mass;
        solid += volume(body);
        for (const MeshAsset::Vertex& v : asset.vertices) {
            const Vec3 p(v.position[0], v.position[1], v.position[2]), n(v.normal[0], v.normal[1], v.normal[2]);
            EXPECT_LE(p.norm(), 0.5 + 1e-6);
            EXPECT_NEAR(n.norm(), 1.0, 1e-6);
        }
    }
    const double ball = 4.0 / 3.0 * 3.14159265358979 * 0.125;
    EXPECT_NEAR(drawn, ball, 0.005 * ball);
    EXPECT_NEAR(solid, ball, 0.07 * ball);
}

TEST(Fracture, CutsEveryCurvedShapeOfAnySize) {
    for (const std::string& size : std::vector<std::string>{"0.001", "0.37", "1", "2.5", "1000"})
        for (const std::string& kind : std::vector<std::string>{
                 "sphere\", radius = " + size, "capsule\", radius = " + size + ", height = " + size,
                 "cylinder\", radius = " + size + ", height = " + size,
                 "cone\", radius = " + size + ", height = " + size,
                 "ellipsoid\", radii = [" + size + ", " + size + ", 1.7]"}) {
            const SceneDescription scene = cut("shape = { type = \"" + kind + " }\n", "cells = 12");
            EXPECT_EQ(scene.bodies.size(), 13u) << kind;
            for (const BodyDescription& body : scene.bodies)
                if (body.piece_of) {
                    EXPECT_TRUE(convex_polyhedron(mesh_of(body), Vec3::Zero())) << kind;
                }
        }
}

TEST(Fracture, VolumesOfVoronoiCellsAddUp) {
    for (const int cells : {2, 20, 60, 200}) {
        const SceneDescription scene = cut(box, "cells = " + std::to_string(cells));
        EXPECT_EQ(scene.bodies.size(), std::size_t(1 + cells));
        double sum = 0.0;
        for (const BodyDescription& body : scene.bodies)
            if (body.piece_of) sum += volume(body);
        EXPECT_NEAR(sum, 1.0, 2e-15) << cells;
    }
}

TEST(Fracture, PiecesAreClosedConvexAndBesideEachOther) {
    for (const std::string& pattern : patterns) {
        const SceneDescription scene = cut(shapes[6], pattern);
        std::vector<ConvexCell> cells;
        for (const BodyDescription& body : scene.bodies) {
            if (!body.piece_of) continue;
            EXPECT_TRUE(closedness(mesh_of(body)).closed());
            BodyDescription alone = body;
            cells.push_back(convex_parts(alone).front().cell);
        }
        for (std::size_t i = 0; i < cells.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                ConvexCell shared = cells[i];
                for (const ConvexCell::Face& face : cells[j].faces) shared.clip({face.normal, face.offset}, 1e-13);
                EXPECT_LE(shared.volume(), 1e-12) << pattern << " " << i << " " << j;
            }
    }
}

TEST(Fracture, EachInnerFaceOfACellHasItsBond) {
    const SceneDescription scene = cut(box, "cells = 60");
    const FractureDescription& f = fracture(scene);
    double faces = 0.0, bonds = 0.0, outer = 0.0;
    for (const Bond& bond : f.bonds) {
        EXPECT_LT(bond.a, bond.b);
        EXPECT_LT(bond.b, f.pieces);
        EXPECT_GT(bond.length, 0.0);
        EXPECT_GT(bond.area, 0.0);
        EXPECT_NEAR((bond.axis1.cross(bond.axis2) - bond.normal).norm(), 0.0, 1e-14);
        bonds += bond.area;
    }
    for (std::size_t i = 0; i < f.pieces; ++i) {
        const TriangleMesh& mesh = mesh_of(scene.bodies[f.first_piece + i]);
        for (const auto& t : mesh.triangles) {
            const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
            const double area = 0.5 * (b - a).cross(c - a).norm();
            const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
            const bool on_side =
                ((low - high).cwiseAbs().array() < 1e-12 && low.cwiseAbs().array() > 0.5 - 1e-12).any();
            (on_side ? outer : faces) += area;
        }
    }
    EXPECT_NEAR(outer, 6.0, 1e-12);
    EXPECT_NEAR(2.0 * bonds, faces, 60 * 60 * 1e-6);  // slivers have none
}

TEST(Fracture, SlabsAreEqualAndHaveTheSectionOfTheBar) {
    const SceneDescription scene =
        cut("shape = { type = \"box\", size = [3, 0.2, 0.1] }\n", "cells = 30, pattern = \"slabs\"");
    const FractureDescription& f = fracture(scene);
    ASSERT_EQ(f.pieces, 30u);
    ASSERT_EQ(f.bonds.size(), 29u);
    for (std::size_t i = 0; i < f.bonds.size(); ++i) {
        const Bond& bond = f.bonds[i];
        EXPECT_EQ(bond.a, i);
        EXPECT_EQ(bond.b, i + 1);
        EXPECT_NEAR(bond.center.x(), -1.5 + 0.1 * double(i + 1), 1e-14);
        EXPECT_NEAR(bond.area, 0.02, 1e-16);
        EXPECT_NEAR(bond.length, 0.1, 1e-14);
        EXPECT_EQ(bond.axis1, Vec3::UnitY());
        EXPECT_NEAR(bond.moment1, 0.2 * 0.1 * 0.1 * 0.1 / 12.0, 1e-18);
        EXPECT_NEAR(bond.moment2, 0.1 * 0.2 * 0.2 * 0.2 / 12.0, 1e-18);
        EXPECT_NEAR(bond.modulus1, 0.2 * 0.1 * 0.1 / 6.0, 1e-17);
        EXPECT_NEAR(bond.modulus2, 0.1 * 0.2 * 0.2 / 6.0, 1e-17);
    }
    const SceneDescription along = cut(box, "cells = 4, pattern = \"slabs\", axis = [0, 0, 2]");
    EXPECT_EQ(fracture(along).bonds.front().normal, Vec3::UnitZ());
}

TEST(Fracture, ASectionHasItsPrincipalAxes) {
    // A rectangle of 2 by 1 that is turned by 30 degrees about z.
    const double c = std::sqrt(0.75), s = 0.5;
    std::vector<Vec3> corners;
    for (const auto& [x, y] : {std::pair(-1.0, -0.5), {1.0, -0.5}, {1.0, 0.5}, {-1.0, 0.5}})
        corners.emplace_back(3.0 + c * x - s * y, 4.0 + s * x + c * y, 5.0);
    const auto bond = section_of(corners, Vec3::UnitZ(), 0.0);
    ASSERT_TRUE(bond);
    EXPECT_NEAR(bond->area, 2.0, 1e-14);
    EXPECT_NEAR((bond->center - Vec3(3, 4, 5)).norm(), 0.0, 1e-14);
    const double small = 2.0 / 12.0, large = 8.0 / 12.0;  // about the long and the short axis
    EXPECT_NEAR(std::min(bond->moment1, bond->moment2), small, 1e-14);
    EXPECT_NEAR(std::max(bond->moment1, bond->moment2), large, 1e-14);
    const Vec3& along = bond->moment1 < bond->moment2 ? bond->axis1 : bond->axis2;
    EXPECT_NEAR(std::abs(along.dot(Vec3(c, s, 0.0))), 1.0, 1e-14);
    EXPECT_FALSE(section_of(corners, Vec3::UnitZ(), 2.1));
}

TEST(Fracture, AWallHoldsAtItsSides) {
    const std::string wall = "type = \"fixed\"\n" + shapes[2];
    const auto held = [&](const std::string& keys) {
        std::vector<Bond> bonds;
        for (const Bond& bond : fracture(cut(wall, "cells = 30, pattern = \"slabs\"" + keys)).bonds)
            if (bond.b == Bond::world) bonds.push_back(bond);
        return bonds;
    };
    const std::vector<Bond> bottom = held("");
    ASSERT_EQ(bottom.size(), 1u);
    EXPECT_EQ(bottom.front().a, 0u);
    EXPECT_NEAR(bottom.front().center.y(), -1.5, 1e-15);
    EXPECT_EQ(bottom.front().normal, -Vec3::UnitY());
    EXPECT_NEAR(bottom.front().length, 0.05, 1e-14);
    EXPECT_EQ(held(", held = [\"-y\", \"+y\"]").size(), 2u);
    EXPECT_EQ(held(", held = [\"+x\"]").size(), 30u);
    for (const Bond& bond : fracture(cut(shapes[2], "cells = 30")).bonds) EXPECT_NE(bond.b, Bond::world);
}

TEST(Fracture, TheMirrorImageOfSitesGivesTheMirrorCut) {
    BodyDescription body;
    body.shape = BoxShape{Vec3(1.0, 2.0, 3.0)};
    const ConvexCell part = convex_parts(body).front().cell;
    Random random(3, 0, Random::Purpose::cut);
    const std::vector<Vec3> sites = draw_sites(part, 40, std::nullopt, random);
    std::vector<Vec3> mirrored = sites;
    for (Vec3& site : mirrored) site.y() = -site.y();
    std::vector<ConvexCell> cells, others;
    cut_by_sites(part, sites, {1e-13, 0.0, 0.0}, cells);
    cut_by_sites(part, mirrored, {1e-13, 0.0, 0.0}, others);
    ASSERT_EQ(cells.size(), others.size());
    const auto volumes = [](const std::vector<ConvexCell>& all) {
        std::vector<double> values;
        for (const ConvexCell& cell : all) values.push_back(cell.volume());
        std::sort(values.begin(), values.end());
        return values;
    };
    const std::vector<double> left = volumes(cells), right = volumes(others);
    for (std::size_t i = 0; i < left.size(); ++i) EXPECT_NEAR(left[i], right[i], 1e-14) << i;
}

TEST(Fracture, SmallCellsGoToTheirNeighbors) {
    for (const std::string& pattern : patterns) {
        const SceneDescription scene = cut(shapes[3], pattern + ", smallest = 0.15");
        double least = infinity;
        for (const BodyDescription& body : scene.bodies)
            if (body.piece_of) least = std::min(least, volume(body));
        EXPECT_GE(least, 0.15 * 0.15 * 0.15 * (1.0 - 1e-9)) << pattern;
    }
}

TEST(Fracture, CopiesBreakInTheirOwnWay) {
    const SceneDescription scene = cut(box + "grid = { count = [2, 1, 1], spacing = 2 }\n", "cells = 5");
    ASSERT_EQ(scene.bodies.size(), 12u);
    EXPECT_EQ(scene.bodies[2].name, "pane.0/0");
    EXPECT_EQ(scene.bodies[7].name, "pane.1/0");
    EXPECT_EQ(scene.bodies[7].piece_of, 1u);
    EXPECT_EQ(scene.bodies[1].fracture->first_piece, 7u);
    EXPECT_NE(volume(scene.bodies[2]), volume(scene.bodies[7]));
    EXPECT_EQ(scene.bodies[7].position, scene.bodies[1].position);
    const SceneDescription other = cut(box + "position = [3, 0, 0]\n", "cells = 5");
    EXPECT_EQ(volume(other.bodies[1]), volume(scene.bodies[2]));
}

TEST(Fracture, InnerFacesHaveTheirOwnColor) {
    const SceneDescription scene = cut(box + "color = \"#102030\"\ninner_color = \"#ff0000\"\n", "cells = 5");
    for (const BodyDescription& body : scene.bodies) {
        if (!body.piece_of) continue;
        const auto& mesh = std::get<MeshShape>(body.shape);
        ASSERT_NE(mesh.paint(), nullptr);
        ASSERT_EQ(mesh.paint()->materials.size(), 2u);
        EXPECT_EQ(mesh.paint()->materials[1].color, (std::array<float, 3>{1.0f, 0.0f, 0.0f}));
        std::size_t inner = 0;
        for (const std::uint32_t material : mesh.paint()->material_of_triangle) inner += material;
        EXPECT_GT(inner, 0u);
        EXPECT_EQ(body.appearance.color, (Color{0x10, 0x20, 0x30}));
    }
}

TEST(Fracture, DefaultsOfTheMaterialFollowFromTheStrength) {
    const FractureDescription f = fracture(cut(box, "cells = 2"));
    EXPECT_EQ(f.strength, 1e6);
    EXPECT_EQ(f.shear_strength, 1.6e6);
    EXPECT_EQ(f.compressive_strength, 0.0);
    EXPECT_EQ(f.stiffness, 1e9);
    EXPECT_EQ(f.toughness, 10.0);
    EXPECT_NEAR(f.blow_time, 2.0 * std::sqrt(3.0) / std::sqrt(1e9 / 1000.0), 1e-15);
}

// Faces of plates are divided at their rims: without gaps between triangles, and with the surface of the cell.
TEST(Fracture, DrawnSurfacesAreClosed) {
    for (const std::size_t flat_one : {0, 1, 2, 5, 6}) {
        const std::string& shape = shapes[flat_one];
        const SceneDescription scene = cut(shape, "cells = 9");
        for (const BodyDescription& body : scene.bodies) {
            if (!body.piece_of) continue;
            const MeshAsset& asset = *std::get<MeshShape>(body.shape).asset;
            using Point = std::array<float, 3>;
            std::map<std::pair<Point, Point>, int> edges;
            double drawn = 0.0, flat = 0.0;
            const auto point = [&](std::size_t i) {
                const float(&p)[3] = asset.vertices[asset.indices[i]].position;
                return Point{p[0], p[1], p[2]};
            };
            const auto vec = [](const Point& p) { return Vec3(p[0], p[1], p[2]); };
            for (std::size_t t = 0; t < asset.indices.size(); t += 3) {
                for (std::size_t k = 0; k < 3; ++k) ++edges[{point(t + k), point(t + (k + 1) % 3)}];
                const Vec3 a = vec(point(t)), b = vec(point(t + 1)), c = vec(point(t + 2));
                drawn += 0.5 * (b - a).cross(c - a).norm();
            }
            for (const auto& [edge, count] : edges)
                if (edge.first != edge.second) {
                    EXPECT_EQ(count, (edges[{edge.second, edge.first}])) << shape;
                }
            for (const auto& [a, b, c] : asset.mesh.triangles) {
                const auto& v = asset.mesh.vertices;
                flat += 0.5 * (v[b] - v[a]).cross(v[c] - v[a]).norm();
            }
            EXPECT_NEAR(drawn, flat, 1e-5 * flat) << shape;
        }
    }
}

TEST(Fracture, EveryKeyChangesTheHash) {
    const std::string fixed = "type = \"fixed\"\n";
    std::set<std::string> scenes, motions;
    const std::vector<std::string> bodies = {box + "fracture = { cells = 5 }\n",
                                             box + "fracture = { cells = 6 }\n",
                                             box + "fracture = { cells = 5, pattern = \"slabs\" }\n",
                                             box + "fracture = { cells = 5, seed = 2 }\n",
                                             box + "fracture = { cells = 5, focus = [0.1, 0, 0] }\n",
                                             box + "fracture = { cells = 5, focus = \"impact\" }\n",
                                             box + "fracture = { cells = 5, pattern = \"slabs\", axis = [0, 1, 0] }\n",
                                             box + "fracture = { cells = 5, depth = 1 }\n",
                                             box + "fracture = { cells = 5, smallest = 0.01 }\n",
                                             fixed + box + "fracture = { cells = 5 }\n",
                                             fixed + box + "fracture = { cells = 5, held = [\"+y\"] }\n",
                                             box + "fracture = { cells = 5 }\nshear_strength = 2\n",
                                             box + "fracture = { cells = 5 }\ncompressive_strength = 2\n",
                                             box + "fracture = { cells = 5 }\nstiffness = 2\nblow_time = 1\n",
                                             box + "fracture = { cells = 5 }\ntoughness = 2\n",
                                             box + "fracture = { cells = 5 }\nblow_time = 1\n"};
    for (const std::string& body : bodies) {
        scenes.insert(scene_hash(scene_of(body)));
        motions.insert(motion_hash(scene_of(body)));
    }
    EXPECT_EQ(scenes.size(), bodies.size());
    EXPECT_EQ(motions.size(), bodies.size());
    const SceneDescription red = scene_of(bodies.front() + "inner_color = \"#ff0000\"\n");
    EXPECT_FALSE(scenes.contains(scene_hash(red)));
    EXPECT_TRUE(motions.contains(motion_hash(red)));
    const auto of_material = [&](const std::string& keys) {
        return scene_hash(parse_scene("format = 1\n[materials.glass]\n" + keys + "[[body]]\nmaterial = \"glass\"\n" +
                                          box + "fracture = { cells = 5 }\n",
                                      "fracture.toml"));
    };
    EXPECT_NE(of_material("strength = 1\n"), of_material("strength = 2\n"));
}

}  // namespace
}  // namespace tumble::fracture_test
