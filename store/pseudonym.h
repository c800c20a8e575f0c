// The pattern that a study gives its pseudonyms, and their check digit.
//
// A pattern has `#` for a digit, `?` for a capital letter, and every other sign for itself; a `C` at its end is the
// check digit: "S###C" fits S0019. The check digit covers the digits and letters at `#` and `?`, from left to right
// (A = 10 ... Z = 35, as two digits), not the fixed signs.
#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace striae::store {

/// One decimal check digit over decimal digits:
/// "iso7064": MOD 11,10 of ISO/IEC 7064:2003 (hybrid system; all single errors, nearly all transpositions);
/// "luhn": mod 10, ISO/IEC 7812-1 annex B; "verhoeff": J. Verhoeff, Error Detecting Decimal Codes, 1969 (all single
/// errors and all transpositions of neighbours). kUsage for another name or anything but digits.
Result<char> CheckDigitOf(std::string_view digits, std::string_view method);

/// kUsage when a study cannot have this: no place to count, a sign that a pseudonym cannot have, more than 32 signs,
/// a method without `C`, `C` without a method or an unknown one. Both empty: any pseudonym.
Status CheckPattern(std::string_view pattern, std::string_view method);

/// kUsage when `pseudonym` does not fit. Where only the check digit is missing it is named; where a wrong one was typed
/// it is not, because any other digit can be the wrong one.
Status CheckPseudonym(std::string_view pseudonym, std::string_view pattern, std::string_view method);

}  // namespace striae::store
