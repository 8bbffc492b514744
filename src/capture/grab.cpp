#include <utility>

#include "capture/frame_source.h"

namespace bole {

void Grab::take(Frame newest, bool stamp_corrected) {
  if (frame) ++drops[DropCause::superseded];
  stamps_corrected += stamp_corrected ? 1 : 0;
  kind = Kind::frame;
  frame = std::move(newest);
}

void Grab::refuse(DropCause cause, std::string why) {
  ++drops[cause];
  reason = std::move(why);
  if (kind == Kind::timeout) kind = Kind::bad_frame;
}

void Grab::lose(std::string why) {
  frame = Frame();
  kind = Kind::lost;
  reason = std::move(why);
}

}  // namespace bole
