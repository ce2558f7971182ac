# Writes OUTPUT, a C++ table of the files NAMES under SOURCE: see resource.cpp.
set(table "")
foreach(name IN LISTS NAMES)
  file(READ "${SOURCE}/${name}" text)
  string(APPEND table "    {\"${name}\", R\"toile(${text})toile\"},\n")
endforeach()

file(WRITE "${OUTPUT}" "// Made by schemas/embed.cmake.\n#include \"schemas/resource_table.h\"\n
namespace toile {
std::span<const Resource> resource_table() {
  static constexpr Resource table[] = {\n${table}  };
  return table;
}
}  // namespace toile\n")
