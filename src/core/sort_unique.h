// Turns a list into an ascending set.
#pragma once

#include <algorithm>
#include <vector>

namespace tumble {

template <class T>
void sort_unique(std::vector<T>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace tumble
