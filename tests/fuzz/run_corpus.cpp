// Runs a fuzz target over the files of a folder, and over a fixed number of changed copies of each:
// what ctest does everywhere, where libFuzzer needs clang.
//
// usage: run_<target> FOLDER

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "fuzz/fuzz_target.h"

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// A few bytes replaced, a piece cut out or doubled.
Bytes changed(Bytes bytes, std::minstd_rand& random) {
  const auto below = [&](std::size_t bound) { return random() % bound; };
  for (std::size_t changes = 1 + below(4); changes > 0 && !bytes.empty(); --changes) {
    const std::size_t first = below(bytes.size());
    const std::size_t length = 1 + below(std::min<std::size_t>(bytes.size() - first, 16));
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(first);
    const Bytes piece(begin, begin + static_cast<std::ptrdiff_t>(length));
    switch (below(4)) {
      case 0:
        bytes.erase(begin, begin + static_cast<std::ptrdiff_t>(length));
        break;
      case 1:
        bytes.insert(begin, piece.begin(), piece.end());
        break;
      default:
        *begin = static_cast<std::uint8_t>(below(2) == 0 ? below(256) : "-.0e9#\n[\""[below(9)]);
    }
  }
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  constexpr int kCopies = 3000;
  std::minstd_rand random(1);
  int runs = 0;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1])) files.push_back(entry);
  std::ranges::sort(files);
  for (const std::filesystem::path& path : files) {
    const Bytes bytes = read(path);
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    for (int copy = 0; copy < kCopies; ++copy, ++runs) {
      const Bytes other = changed(bytes, random);
      LLVMFuzzerTestOneInput(other.data(), other.size());
    }
  }
  std::printf("%zu files, %d changed copies\n", files.size(), runs);
  return files.empty() ? 1 : 0;
}
