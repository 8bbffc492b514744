#pragma once

#include <string>

#include "bole/status_t.hpp"
#include "bole/tree_list_t.hpp"

namespace bole {

/// One line of JSON, closed by a line feed, into `line`, which keeps its capacity: the field names
/// of tree_list_t, floats in the fewest digits that read back as the same float, and `file` first
/// where it is not empty.
void write_json_line(const tree_list_t& list, const std::string& file, std::string& line);

/// As above for a status.
void write_json_line(const status_t& status, std::string& line);

}  // namespace bole
