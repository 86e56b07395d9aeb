#include "contact/contact_case.h"

namespace tumble::bench {

std::vector<ContactCase> contact_cases() {
    std::vector<ContactCase> cases;
    add_piles(cases);
    add_spheres(cases);
    add_towers(cases);
    add_slides(cases);
    return cases;
}

}  // namespace tumble::bench
