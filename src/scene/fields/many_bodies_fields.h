// Fields of tables that make many bodies: grids, scatters and files of poses of [[body]], [[chain]], [template.NAME]
// and [[instance]].
#pragma once

#include "scene/fields/choices.h"
#include "scene/fields/field.h"
#include "scene/toml/limits.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

struct GridRequest {
    std::array<int, 3> count{1, 1, 1};  // along x, y, z
    Vec3 spacing = Vec3::Zero();        // m between neighbors' origins
    Vec3 jitter = Vec3::Zero();         // m: largest displacement of a copy to either side
    double tilt = 0.0;                  // degrees: largest rotation of a copy about a random axis
};

template <class Visitor, class Self>
void visit_fields(Of<GridRequest>, Visitor& field, Self& self) {
    field(self.count, "count", Required(ByCode()), {"along x, y, z", {}, "1 and up", "three whole numbers"});
    field(self.spacing, "spacing", Required(NumberOrVector{limits::size}), {"between the origins of neighbors"});
    field(self.jitter, "jitter", NumberOrVector{limits::size_or_zero},
          {"largest random displacement of each copy, in both directions", "0"});
    field(self.tilt, "tilt", limits::tilt, {"largest random rotation of each copy, about a random axis"});
}

struct ScatterRequest {
    int count = 1;
    Vec3 size = Vec3::Zero();  // m, of the box that contains the copies' origins
    bool random_rotation = true;
    double clearance = 0.0;  // m between the copies' bounding spheres
};

template <class Visitor, class Self>
void visit_fields(Of<ScatterRequest>, Visitor& field, Self& self) {
    field(self.count, "count", Required(Whole{1, limits::bodies}));
    field(self.size, "size", Required(limits::size_or_zero), {"of the box in which the copies' origins lie"});
    field(self.random_rotation, "rotation", Words{"random", "none", true},
          {"`\"random\"`: a uniformly random rotation; `\"none\"`: the body's `rotation`"});
    field(self.clearance, "clearance", limits::size_or_zero, {"between the bounding spheres"});
}

/// Keys of a body beside its grid or scatter.
struct CopyLooks {
    double min_scale = 1.0, max_scale = 1.0;
    std::vector<Color> colors;  // empty: all have the body's color
};

template <class Visitor, class Self>
void visit_fields(Of<CopyLooks>, Visitor& field, Self& self) {
    field.key("scale",
              {"each copy is scaled by a random factor from the smallest to the largest. Meshes and compounds use nine "
               "sizes, so that copies share geometry",
               "`[1, 1]`", "0.001 to 1,000", "two numbers"});
    field.inner(self.min_scale, self.max_scale);
    field(self.colors, "colors", ByType(), {"each copy takes one at random", "the body's"});
}

/// A row of a file of poses. A field named "x,y,z" has these three columns: a file has all of them or none.
struct PoseRow {
    Vec3 position = Vec3::Zero();
    std::string name;
    Quat rotation = Quat::Identity();
    Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
};

template <class Visitor, class Self>
void visit_fields(Of<PoseRow>, Visitor& field, Self& self) {
    field(self.position, "x,y,z", Required(limits::coordinate), {"in place of `position`"});
    field(self.name, "body", NotEmpty(),
          {"in place of `name`", "`NAME.0`, `NAME.1`, … as of copies", "unique, not empty"});
    field(self.rotation, "qw,qx,qy,qz", ByType(), {"in place of `rotation`", {}, "of length 1", "quaternion"});
    field(self.velocity, "vx,vy,vz", limits::velocity, {"in place of `velocity`; dynamic bodies"});
    field(self.angular_velocity, "wx,wy,wz", limits::angular_velocity,
          {"in place of `angular_velocity`; dynamic bodies"});
}

struct ChainRequest {
    /// The other side of the joint at an end.
    struct End {
        bool joined = false;
        std::optional<std::size_t> body;  // empty: the world
    };

    std::string name;
    std::size_t links = 1;
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();  // m
    std::optional<double> sag, length;            // m
    std::array<End, 2> ends;
    bool loop = false;
    std::optional<Vec3> normal;  // of unit length
    double twist = 0.0;          // degrees
    std::vector<Color> colors;   // empty: all have the color of the model
};

template <class Visitor, class Self>
void visit_fields(Of<ChainRequest>, Visitor& field, Self& self) {
    field(self.name, "name", Required(NotEmpty()), {{}, {}, "unique, not empty"});
    field(self.links, "links", Required(Whole{1, limits::links}), {{}, {}, "1 to 1,000,000; 3 and up in a loop"});
    field(self.from, "from", Required(limits::coordinate), {"one end"});
    field(self.to, "to", Required(limits::coordinate), {"the other end, at another point"});
    field(self.sag, "sag", limits::size,
          {"depth of the middle of the chain below the middle of its ends", "none: straight"});
    field(self.length, "length", limits::size,
          {"in place of `sag`: of all links together", "none: straight", "at least the distance of the ends"});
    field(self.ends, "ends", ByCode(),
          {"the body at each end, `\"world\"` or `\"free\"`", "`[\"free\", \"free\"]`", {}, "two strings"});
    field(self.loop, "loop", ByType(),
          {"the links form a regular polygon. `from` is a corner, and the middle of `from` and `to` is the center"});
    field(self.normal, "normal", Direction(),
          {"of the plane of a loop", "horizontal", "square to the line from `from` to `to`"});
    field.key("joint",
              {"`\"ball\"`, `\"hinge\"`, `\"universal\"` or `\"fixed\"`; or a table with `type` and keys of a joint, "
               "without its bodies and anchors. The axis of a hinge is the normal of the chain's plane, or `axis`",
               "`\"ball\"`",
               {},
               "string or table"});
    field(self.twist, "twist", limits::angle, {"turn of each link about the chain, relative to the link before"});
    field(self.colors, "colors", ByType(), {"links take them in turn", "the color of the links"});
    field.key("shape", {"as in a body, for each link", "required", {}, "table"});
    for (const char* one : {"material", "visible", "mass", "velocity", "integrator"})
        field.key(one, {"as in a body, for each link"});
}

/// A template: a file, or bodies, joints and chains.
struct TemplateRequest {
    std::string file;  // empty: none
};

void visit_template_content(auto& field) {
    for (const char* one : {"body", "joint", "chain"})
        field.key(one, {"as in a scene, with names of their own", "none", {}, "tables"});
}

template <class Visitor, class Self>
void visit_fields(Of<TemplateRequest>, Visitor& field, Self& self) {
    field(self.file, "file", NotEmpty(), {"in place of the others: a file with them", "none"});
    visit_template_content(field);
}

struct TemplateFile {};

template <class Visitor, class Self>
void visit_fields(Of<TemplateFile>, Visitor& field, Self&) {
    field.key("format", {"for readers; 1", "none", {}, "whole number"});
    field.key("title", {"for readers", "none", {}, "string"});
    field.key("materials", {"as in a scene, for the bodies of this file", "none", {}, "tables"});
    visit_template_content(field);
}

struct InstanceRequest {
    std::string of, name;
    Vec3 position = Vec3::Zero();
    Quat rotation = Quat::Identity();
    Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
    double scale = 1.0;
    std::optional<double> mass;  // kg
    std::optional<Color> color;
};

template <class Visitor, class Self>
void visit_fields(Of<InstanceRequest>, Visitor& field, Self& self) {
    field(self.of, "template", Required(ByType()), {"its name"});
    field(self.name, "name", Required(NotEmpty()),
          {"bodies are `NAME.BODY`, joints `NAME.JOINT`", {}, "unique, not empty"});
    field(self.position, "position", limits::coordinate, {"of the origin of the template"});
    field(self.rotation, "rotation", ByType(), {"see [rotations](scene-format.md#rotations)"});
    field(self.velocity, "velocity", limits::velocity, {"of all dynamic bodies, in addition to their own"});
    field(self.angular_velocity, "angular_velocity", limits::angular_velocity, {"of the whole about its origin"});
    field.key("pose", {"coordinates of hinges (degrees, ±180) and sliders (m) by name", "none",
                       "within the limits of the joints", "table"});
    field(self.scale, "scale", limits::copy_scale, {"see below"});
    field(self.mass, "mass", limits::mass, {"of all dynamic bodies together", "from the template"});
    field(self.color, "color", ByType(), {"of all bodies", "the template's colors"});
    for (const char* one : {"grid", "scatter", "colors"})
        field.key(one, {"as in [bodies](scene-format.md#many-bodies-from-one-table); copies are `NAME.0.BODY`, and a "
                        "copy has one color",
                        "none"});
}

}  // namespace tumble
