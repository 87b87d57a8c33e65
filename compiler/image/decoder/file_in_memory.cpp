#include "compiler/image/decoder/file_in_memory.hpp"

#include <dlfcn.h>

#include <cstdio>

namespace wale::decoder {
namespace {

std::string held_name;
std::span<const std::byte> held_bytes;

}  // namespace

FileInMemory::FileInMemory(const std::string& name, std::span<const std::byte> bytes) {
  held_name = name;
  held_bytes = bytes;
}

FileInMemory::~FileInMemory() {
  held_name.clear();
  held_bytes = {};
}

}  // namespace wale::decoder

/// Takes the place of the C library's function in this program and all its libraries.
extern "C" std::FILE* fopen(const char* name, const char* mode) {
  using namespace wale::decoder;
  if (!held_name.empty() && held_name == name)
    return fmemopen(const_cast<std::byte*>(held_bytes.data()), held_bytes.size(), "rb");
  using Open = std::FILE* (*)(const char*, const char*);
  static const auto original = reinterpret_cast<Open>(dlsym(RTLD_NEXT, "fopen"));
  return original(name, mode);
}
