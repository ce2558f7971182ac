#include "server/command/drape_state.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace toile {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr std::string_view kMagic = "toile drape state 1\n";

class Writer {
 public:
  Writer() : bytes_(kMagic) {}
  template <typename T>
  void one(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <typename T>
  void list(const std::vector<T>& values) {
    one<std::uint64_t>(values.size());
    for (const T& value : values) one(value);
  }
  void text(const std::string& value) {
    one<std::uint64_t>(value.size());
    bytes_ += value;
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {
    if (rest_.substr(0, kMagic.size()) != kMagic) throw std::runtime_error("this is no drape state of this version");
    rest_.remove_prefix(kMagic.size());
  }
  template <typename T>
  void one(T& value) {
    need(sizeof value);
    std::memcpy(static_cast<void*>(&value), rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
  }
  std::uint64_t count(std::size_t size_of_one) {
    std::uint64_t number = 0;
    one(number);
    if (number > rest_.size() / size_of_one) throw std::runtime_error("the drape state is cut short");
    return number;
  }
  template <typename T>
  void list(std::vector<T>& values) {
    values.resize(count(sizeof(T)));
    for (T& value : values) one(value);
  }
  void text(std::string& value) {
    const std::uint64_t length = count(1);
    value = rest_.substr(0, length);
    rest_.remove_prefix(length);
  }

 private:
  void need(std::size_t size) const {
    if (rest_.size() < size) throw std::runtime_error("the drape state is cut short");
  }
  std::string_view rest_;
};

/// The one list of what is kept, for writing and for reading.
template <typename Archive, typename State>
void visit(Archive& archive, State& state) {
  archive.one(state.width);
  archive.one(state.height);
  auto& drape = state.drape;
  archive.list(drape.cloth.x);
  archive.list(drape.cloth.triangles);
  archive.list(drape.cloth.flat);
  archive.list(drape.cloth.triangle_panel);
  archive.list(drape.cloth.vertex_garment);
  archive.list(drape.body_mesh.vertices);
  archive.list(drape.body_mesh.triangles);
  archive.list(drape.contact_force);
  archive.list(drape.stretch_warp);
  archive.list(drape.stretch_weft);
}

}  // namespace

std::string write_drape_state(const Drape& drape, int width, int height) {
  struct {
    const Drape& drape;
    int width, height;
  } const state{drape, width, height};
  Writer writer;
  visit(writer, state);
  writer.one<std::uint64_t>(drape.cloth.panels.size());
  for (const ClothPanel& panel : drape.cloth.panels) {
    writer.one(panel.garment);
    writer.one(panel.fabric);
    writer.text(panel.name);
  }
  writer.one<std::uint64_t>(drape.cloth.fabrics.size());
  for (const Fabric& fabric : drape.cloth.fabrics) {
    writer.text(fabric.name);
    writer.one(fabric.thickness);
  }
  return writer.take();
}

DrapeState read_drape_state(std::string_view bytes) {
  DrapeState state;
  Reader reader(bytes);
  visit(reader, state);
  state.drape.cloth.panels.resize(reader.count(1));
  for (ClothPanel& panel : state.drape.cloth.panels) {
    reader.one(panel.garment);
    reader.one(panel.fabric);
    reader.text(panel.name);
  }
  state.drape.cloth.fabrics.resize(reader.count(1));
  for (Fabric& fabric : state.drape.cloth.fabrics) {
    reader.text(fabric.name);
    reader.one(fabric.thickness);
  }
  return state;
}

}  // namespace toile
