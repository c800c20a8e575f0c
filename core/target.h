// Printed targets: the ChArUco board that a rig is calibrated with, and the label that tells a photograph's session
// and, by its known size, the distance. Both must stay readable under the stripes (period on the object about 2.1 mm at
// 1 m, 10.4 mm at 2 m), so their modules are large; what draws them is report/print.
#pragma once

#include <string>
#include <string_view>

#include "core/id.h"
#include "core/study.h"

namespace striae {

/// A chessboard with an ArUco marker in every white square, as OpenCV's CharucoBoard has it; seen from the front the
/// top-left square is black. `rows` is odd, so that old and new versions of OpenCV agree on which squares are black.
/// Markers are numbered from 0, row by row from the top-left white square.
struct CharucoBoard {
  int columns = 0, rows = 0;  ///< squares
  double square_mm = 0;       ///< side of a square
  double marker_mm = 0;       ///< side of a marker with its black border, centred in its square
  std::string dictionary;     ///< OpenCV's name
  bool operator==(const CharucoBoard&) const = default;
};

/// Its markers have 5x5 bits, a label's 4x4: none is taken for one of the other at its size.
inline constexpr std::string_view kBoardDictionary = "DICT_5X5_50";

/// 7 x 5 squares: 252 x 180 mm on A4 landscape (small range), 364 x 260 mm on A3 landscape (large range).
/// Markers of 27 and 39 mm have modules of 3.9 mm (nearly two stripes at 1 m) and 5.6 mm (wider than the dark half of a
/// stripe at 2 m). They are three quarters of their squares: wider ones merge with the white square around them in
/// OpenCV's detector (corners nearer than a twentieth of a marker's perimeter).
CharucoBoard BoardFor(RigRange range);

/// One ArUco marker of known size with the session's code.
struct Label {
  int marker_id = 0;         ///< in kLabelDictionary
  double side_mm = 0;        ///< of the marker with its black border of one module: 6 modules
  std::string session_code;  ///< SessionCode()
  bool operator==(const Label&) const = default;
};

inline constexpr std::string_view kLabelDictionary = "DICT_4X4_1000";
inline constexpr int kLabelMarkers = 1000;

/// The first eight digits of the session's id in upper case with a hyphen, "3F2A-91BC": what a person reads and types.
std::string SessionCode(const SessionId& session);
/// The code as digits in lower case ("3f2a91bc", what the ids of such sessions begin with), however it was typed: with
/// or without the hyphen, in either case. Empty when it cannot be a code.
std::string DigitsOfSessionCode(std::string_view typed);

/// CRC-32 (the one of zip and PNG: polynomial 0xEDB88320 reflected) of the id's 16 bytes, modulo kLabelMarkers. Two
/// sessions share a number with probability 1/1000: it checks that a photograph belongs to a session, it does not
/// identify one.
int LabelMarkerId(const SessionId& session);

/// 40 mm: modules of 6.7 mm, three stripes at 1 m. 100 mm: modules of 16.7 mm, 1.6 stripes at 2 m.
double DefaultLabelSideMm(RigRange range);
/// The label of a session.
Label LabelFor(const SessionId& session, double side_mm);

}  // namespace striae
