// What the camera wrote into its file: EXIF and Nikon's MakerNote.
#pragma once

#include <cstdint>
#include <span>

#include "core/result.h"
#include "core/study.h"

namespace striae::acquire {

/// EXIF of a JPEG or NEF. A tag that is absent, malformed or absurd leaves its field empty; a photograph without any
/// EXIF is not an error. width_px and height_px are those of the stored picture (frame header), not of EXIF's claim.
/// kBadImage only when the bytes are not a whole photograph (see CheckStructure). Never throws.
/// Of Nikon's tags only those are taken that agree with other readers for the D90: SerialNumber, ShutterCount (0x00a7,
/// not the encrypted ShotInfo's), Focus, Quality, WhiteBalance, Lens, and FocusDistance and lens from LensData 0204.
/// Flash is EXIF's bit 0, not FlashInfo's flags, which say "fired" when there was no flash.
/// Focus distance: 0.01 m * 10^(byte / 40), steps of 6 %; a byte of 0 means unknown.
Result<PhotoMetadata> ReadMetadata(std::span<const std::uint8_t> bytes);

}  // namespace striae::acquire
