#include "schemas/pointer.h"

#include "engine/mesh/pattern_pointer.h"

namespace toile {

std::string child(std::string pointer, std::string_view key) { return pointer + '/' + pointer_token(key); }

std::string child(std::string pointer, std::size_t index) { return pointer + '/' + std::to_string(index); }

}  // namespace toile
