#include "engine/geometry/dress_form.h"
namespace toile {
TriangleMesh dress_form(const DressFormBody&) { return {}; }
}  // namespace toile
