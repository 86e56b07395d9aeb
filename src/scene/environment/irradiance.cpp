#include "scene/environment/irradiance.h"

#include "core/deterministic_math.h"

#include <cmath>

namespace tumble {

Vec3 direction_of_texel(const EnvironmentImage& image, int x, int y) {
    const auto [sine, cosine] = sincos(pi * (y + 0.5) / image.height);
    const auto [across, along] = sincos(2.0 * pi * ((x + 0.5) / image.width - 0.5));
    return {sine * along, cosine, sine * across};
}

Irradiance irradiance_of(const EnvironmentDescription& environment) {
    const EnvironmentImage& image = *environment.image;
    using Row = Eigen::Matrix<double, 3, 9>;
    const auto [turned_sine, turned_cosine] = sincos(environment.rotation * pi / 180.0);
    std::vector<SinCos> columns;
    for (int x = 0; x < image.width; ++x) columns.push_back(sincos(2.0 * pi * ((x + 0.5) / image.width - 0.5)));
    Row moments = Row::Zero();
    for (int y = 0; y < image.height; ++y) {
        const auto [sine, cosine] = sincos(pi * (y + 0.5) / image.height);
        const double solid_angle =
            (sincos(pi * y / image.height).cos - sincos(pi * (y + 1) / image.height).cos) * 2.0 * pi / image.width;
        Row sum = Row::Zero();
        for (int column = 0; column < image.width; ++column) {
            const auto& texel = image.at(column, y);
            const SinCos& at = columns[std::size_t(column)];
            const double from_x = sine * at.cos, from_z = sine * at.sin;
            const double x = turned_cosine * from_x + turned_sine * from_z,
                         z = turned_cosine * from_z - turned_sine * from_x;
            Eigen::Matrix<double, 9, 1> shapes;
            shapes << 1.0, x, cosine, z, x * cosine, cosine * z, x * z, z * z, x * x - cosine * cosine;
            sum += Vec3(texel[0], texel[1], texel[2]) * shapes.transpose();
        }
        moments += solid_angle * sum;
    }
    // Ramamoorthi and Hanrahan 2001, An Efficient Representation for Irradiance Environment Maps: the lobe of the
    // cosine over pi has 1, 2/3 and 1/4 of the three orders. The factors are the squares of those of the harmonics.
    const double order0 = 1.0 / (4.0 * pi), order1 = 2.0 / 3.0 * 3.0 / (4.0 * pi), order2 = 0.25 * 15.0 / (4.0 * pi);
    Row factors;
    factors.col(0) = order0 * moments.col(0);
    for (int i = 1; i < 4; ++i) factors.col(i) = order1 * moments.col(i);
    for (int i = 4; i < 7; ++i) factors.col(i) = order2 * moments.col(i);
    // 3 z^2 - 1 becomes z^2 and a constant
    const Vec3 along_z = order2 / 12.0 * (3.0 * moments.col(7) - moments.col(0));
    factors.col(7) = 3.0 * along_z;
    factors.col(0) -= along_z;
    factors.col(8) = order2 / 4.0 * moments.col(8);
    Irradiance irradiance{};
    for (Eigen::Index i = 0; i < 9; ++i)
        for (Eigen::Index c = 0; c < 3; ++c)
            irradiance[std::size_t(i)][std::size_t(c)] = float(environment.intensity * factors(c, i));
    return irradiance;
}

}  // namespace tumble
