#pragma once
// OpenVDB's trees and grids as the library already holds them. Compiled anew, with all their members for the sake of
// their vtables, they take half a minute. Without optimisation the library's copies do not do: what was inlined there
// is missing in it.

#include <openvdb/openvdb.h>

#ifdef __OPTIMIZE__
extern template class openvdb::tree::Tree<openvdb::FloatTree::RootNodeType>;
extern template class openvdb::tree::Tree<openvdb::Int32Tree::RootNodeType>;
extern template class openvdb::tree::Tree<openvdb::BoolTree::RootNodeType>;
extern template class openvdb::Grid<openvdb::FloatTree>;
extern template class openvdb::Grid<openvdb::Int32Tree>;
#endif
