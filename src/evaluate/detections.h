#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "detect/tree.h"

namespace bole {

/// What a detector found, by file name without folders.
using Detections = std::map<std::string, std::vector<Tree>>;

/// The line that `bolectl detect` prints for an image, without the line's end: {"file": ...,
/// "trees": [{...}]}, the trees' fields named as in tree_t. Numbers are as short as they can be
/// without loss.
std::string detection_line(const std::string& file, std::span<const Tree> trees);

/// The line for an image that could not be read.
std::string error_line(const std::string& file, const std::string& error);

/// The decimal number that detection_line prints for `value`. What is measured on Trees goes
/// through it, so that figures equal those measured on the lines.
double as_printed(float value);

}  // namespace bole
