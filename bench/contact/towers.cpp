// Structures that should stand: stacks, heavy on light, a pyramid, an arch, a house of cards.
#include "contact/witness.h"
#include "harness/random.h"
#include "harness/shapes.h"

#include <numbers>

namespace tumble::bench {
namespace {

constexpr double pi = std::numbers::pi;

ContactCase standing(const std::string& name, double seconds, double fallen) {
    ContactCase c;
    c.name = name;
    c.seconds = seconds;
    c.witness = [fallen](const Scene& scene) { return witness_of_standing(scene, fallen); };
    return c;
}

ContactCase stack(int boxes) {
    ContactCase c = standing("stack of " + std::to_string(boxes), 60.0, 0.5);
    for (int i = 0; i < boxes; ++i) c.scene.bodies.push_back(box({1.0, 1.0, 1.0}, 1.0, {0.0, 0.0, 0.5 + i}));
    c.scene.bodies.push_back(floor_box());
    set_materials(c.scene, 0.5, 0.0);
    return c;
}

// Tilted by up to 0.02 rad, shifted by up to 5 cm, with falls through gaps of about 3 cm.
ContactCase loose_stack(int boxes) {
    ContactCase c =
        standing("loose stack of " + std::to_string(boxes), 30.0, 4.0);  // sum of the gaps of 30 boxes: 0.9 m
    Random random(11);
    for (int i = 0; i < boxes; ++i) {
        const double y = 0.05 * random.both(), x = 0.05 * random.both();
        Body b = box({1.0, 1.0, 1.0}, 1.0, {x, y, 0.52 + 1.03 * i});
        b.orientation = random.turned(0.02);
        c.scene.bodies.push_back(b);
    }
    c.scene.bodies.push_back(floor_box());
    set_materials(c.scene, 0.5, 0.0);
    return c;
}

ContactCase heavy_on_light(double ratio, const std::string& name) {
    ContactCase c = standing(name, 5.0, 0.1);
    c.look_every = 1.0 / 60.0;
    c.scene.bodies = {box({1.0, 1.0, 1.0}, 1.0, {0.0, 0.0, 0.5}), box({1.0, 1.0, 1.0}, ratio, {0.0, 0.0, 1.5}),
                      floor_box()};
    set_materials(c.scene, 0.5, 0.0);
    return c;
}

ContactCase pyramid(int base, double seconds) {
    ContactCase c = standing("pyramid of " + std::to_string(base * (base + 1) / 2), seconds, 0.5);
    c.look_every = 1.0;
    for (int row = 0; row < base; ++row)
        for (int i = 0; i < base - row; ++i)
            c.scene.bodies.push_back(box({1.0, 1.0, 1.0}, 1.0, {(i - 0.5 * (base - row)) * 1.02, 0.0, 0.5 + row}));
    c.scene.bodies.push_back(floor_box(300.0));
    set_materials(c.scene, 0.5, 0.0);
    return c;
}

// A half circle of stones of equal angle between radii of 4 and 5 m, 1 m deep, on two fixed abutments.
ContactCase arch(int stones) {
    ContactCase c = standing("arch of " + std::to_string(stones) + " stones", 60.0, 0.5);
    const double half = 0.5 * pi / stones, inner = 4.0, outer = 5.0, deep = 1.0, spring = 1.0;
    // Seen along y, a trapezoid between the two chords: z outwards, its sides on rays of the circle.
    const double low = inner * std::cos(half), high = outer * std::cos(half);
    const double a = inner * std::sin(half), b = outer * std::sin(half);  // half chords
    const double center = low + (high - low) * (a + 2.0 * b) / (3.0 * (a + b));
    Body stone;
    stone.kind = Kind::hexahedron;
    stone.mass = 2000.0 * deep * (a + b) * (high - low);
    for (std::size_t i = 0; i < 8; ++i) {
        const double chord = i & 4 ? b : a;
        stone.corners[i] = {i & 1 ? chord : -chord, i & 2 ? 0.5 * deep : -0.5 * deep, (i & 4 ? high : low) - center};
    }
    for (int i = 0; i < stones; ++i) {
        const double angle = (2 * i + 1) * half - 0.5 * pi;  // from the vertical
        stone.orientation = turn({0.0, 1.0, 0.0}, angle);
        stone.position = {center * std::sin(angle), 0.0, spring + center * std::cos(angle)};
        c.scene.bodies.push_back(stone);
    }
    for (const double side : {-1.0, 1.0}) c.scene.bodies.push_back(fixed_box({2.0, 2.0, 1.0}, {4.5 * side, 0.0, 0.5}));
    c.scene.bodies.push_back(floor_box());
    set_materials(c.scene, 0.7, 0.0);
    return c;
}

// Flat hoops of 16 boxes each, 2 m across, one on the other, each rotated slightly relative to the one below.
ContactCase hoops(int count) {
    ContactCase c = standing(std::to_string(count) + " stacked hoops", 60.0, 0.2);
    constexpr int pieces = 16;
    const double radius = 1.0, thick = 0.1, half = pi / pieces;
    Body hoop;
    hoop.kind = Kind::compound;
    for (int i = 0; i < pieces; ++i) {
        const Orientation q = turn({0.0, 0.0, 1.0}, 2.0 * half * i);
        hoop.parts.push_back({{thick, 2.0 * radius * std::tan(half), thick}, rotate(q, {radius, 0.0, 0.0}), q});
    }
    hoop.mass = 10.0;
    for (int i = 0; i < count; ++i) {
        hoop.position = {0.0, 0.0, (0.5 + i) * thick};
        hoop.orientation = turn({0.0, 0.0, 1.0}, 0.7 * i);
        c.scene.bodies.push_back(hoop);
    }
    c.scene.bodies.push_back(floor_box());
    set_materials(c.scene, 0.5, 0.0);
    return c;
}

// Stories of leaning pairs of cards with cards across their tops.
ContactCase card_house(int storeys) {
    ContactCase c = standing("card house of " + std::to_string(storeys) + " storeys", 60.0, 0.2);
    const double length = 0.9, width = 0.6, thick = 0.02, lean = 0.3, mass = 1000.0 * length * width * thick;
    const double s = std::sin(lean), k = std::cos(lean);
    const double up = 0.5 * (length * k + thick * s);     // height of a leaning card's center over its foot
    const double aside = 0.5 * (thick * k + length * s);  // distance of its center from the plane where the two meet
    const double pitch = 0.8, storey = 2.0 * up + thick;
    for (int level = 0; level < storeys; ++level) {
        const int pairs = storeys - level;
        const double first = -0.5 * pitch * (pairs - 1), ground = storey * level;
        for (int i = 0; i < pairs; ++i)
            for (const double side : {-1.0, 1.0}) {
                Body card = box({thick, width, length}, mass, {first + pitch * i + side * aside, 0.0, ground + up});
                card.orientation = turn({0.0, 1.0, 0.0}, -side * lean);
                c.scene.bodies.push_back(card);
            }
        for (int i = 0; i + 1 < pairs; ++i)
            c.scene.bodies.push_back(box({pitch - 0.004, width, thick}, mass * (pitch - 0.004) / length,
                                         {first + pitch * (i + 0.5), 0.0, ground + 2.0 * up + 0.5 * thick}));
    }
    c.scene.bodies.push_back(floor_box());
    set_materials(c.scene, 0.6, 0.0);
    return c;
}

}  // namespace

void add_towers(std::vector<ContactCase>& cases) {
    cases.push_back(stack(20));
    cases.push_back(stack(100));
    cases.push_back(loose_stack(30));
    cases.push_back(heavy_on_light(1e3, "1000 kg on 1 kg"));
    cases.push_back(heavy_on_light(1e6, "1e6 kg on 1 kg"));
    cases.push_back(pyramid(100, 60.0));
    cases.push_back(arch(15));
    cases.push_back(card_house(3));
    cases.push_back(hoops(5));
}

}  // namespace tumble::bench
