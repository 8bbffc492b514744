// Class-specific request codes of USB Video Class 1.1 (appendix A.8).
#pragma once

namespace hil::uvc {

constexpr unsigned kSetCur = 0x01;
constexpr unsigned kGetCur = 0x81;
constexpr unsigned kGetMin = 0x82;
constexpr unsigned kGetMax = 0x83;
constexpr unsigned kGetRes = 0x84;
constexpr unsigned kGetLen = 0x85;
constexpr unsigned kGetInfo = 0x86;
constexpr unsigned kGetDef = 0x87;

constexpr unsigned kCanGetAndSet = 0b11;  // GET_INFO

// The control interface itself
constexpr unsigned kRequestErrorCodeControl = 0x02;
constexpr unsigned kErrorInvalidRequest = 0x07;

// The streaming interface
constexpr unsigned kProbeControl = 0x01;
constexpr unsigned kCommitControl = 0x02;

}  // namespace hil::uvc
