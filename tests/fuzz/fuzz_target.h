#pragma once

#include <cstddef>
#include <cstdint>

/// What libFuzzer calls, and run_corpus.cpp where there is no clang: returns 0, and must neither
/// crash nor touch memory that is not its own, whatever the bytes.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
