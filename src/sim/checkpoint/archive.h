// Writes and reads the state of a simulation as bytes: numbers in little-endian order one after the other, without
// padding, so that equal states have equal bytes on every machine.
//
// Each class with state has one function that names all of its fields, for both directions:
//
//   template <class Archive, class Self>
//   static void visit(Archive& archive, Self& self) {
//       auto& [mass, velocity, spare] = self;
//       archive.rebuilt(mass);    // follows from the scene: right in every world of that scene that has not run yet
//       archive.keep(velocity);   // written and read
//       archive.scratch(spare);   // written before it is read in each step
//   }
//
// A new field does not compile until the function names it. tests/sim/checkpoint/checkpoint_test.cpp compares the
// motion of restored worlds with that of unbroken ones: a field in the wrong group shows there.
//
// Files come from anywhere: the function also declares the bound of each field, and reading refuses a value beyond it.
// keep() takes flags, finite numbers, and classes whose fields declare theirs; whole numbers and enumerations do not
// compile in it:
//
//   archive.body(a, b);                    // indices of bodies
//   archive.enumeration(kind, Kind::last);
//   archive.between(0, count, capacity);
//   archive.count(steps);                  // counted up from 0
//   archive.any(feature);                  // every value is valid
//   archive.unbounded(limit);              // may be infinite
//   archive.require([&] { return first + count <= size; });  // what several fields have to hold together
//
// Structures that follow from other values (trees, lists, islands) are not written, but built anew.
#pragma once

#include "sim/checkpoint/checkpoint_reader.h"
#include "sim/checkpoint/checkpoint_writer.h"
