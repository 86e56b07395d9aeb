#include "sim/contact/direct/gear_row.h"

namespace tumble {

void GearRow::add_side(int body, const double* six, double factor) {
    std::size_t s = 0;
    while (s < count_ && sides_[s].body != body) ++s;
    if (s == count_) {
        sides_[s].body = body;
        ++count_;
    }
    for (std::size_t k = 0; k < 6; ++k) sides_[s].six[k] += factor * six[k];
}

double GearRow::dot(const std::vector<double>& u) const {
    double sum = 0.0;
    for (std::size_t s = 0; s < count_; ++s)
        for (std::size_t k = 0; k < 6; ++k) sum += sides_[s].six[k] * u[6 * std::size_t(sides_[s].body) + k];
    return sum;
}

void GearRow::add(double amount, std::vector<double>& to) const {
    for (std::size_t s = 0; s < count_; ++s)
        for (std::size_t k = 0; k < 6; ++k) to[6 * std::size_t(sides_[s].body) + k] += amount * sides_[s].six[k];
}

void GearRow::add_pairs(std::vector<BlockCholesky::Pair>& pairs) {
    first_pair_ = std::uint32_t(pairs.size());
    for (std::size_t s = 0; s < count_; ++s)
        for (std::size_t t = s + 1; t < count_; ++t)
            pairs.push_back({std::uint32_t(sides_[s].body), std::uint32_t(sides_[t].body)});
}

void GearRow::add_square(BlockCholesky& matrix, double weight) const {
    const auto add_outer_of = [&](BlockCholesky::Block& to, const Side& left, const Side& right) {
        BlockCholesky::Row row{};
        for (int k = 0; k < 6; ++k) row[k] = weight * right.six[std::size_t(k)];
        for (std::size_t k = 0; k < 6; ++k) to.row[k] += left.six[k] * row;
    };
    std::uint32_t pair = first_pair_;
    for (std::size_t s = 0; s < count_; ++s) {
        add_outer_of(matrix.diagonal(std::size_t(sides_[s].body)), sides_[s], sides_[s]);
        for (std::size_t t = s + 1; t < count_; ++t, ++pair) {
            const bool turned = matrix.transposed(pair);
            add_outer_of(matrix.coupling(pair), sides_[turned ? t : s], sides_[turned ? s : t]);
        }
    }
}

}  // namespace tumble
