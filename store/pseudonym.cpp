#include "store/pseudonym.h"

#include <algorithm>
#include <array>

namespace striae::store {
namespace {

constexpr std::size_t kLongest = 32;
constexpr std::array<std::string_view, 3> kMethods = {"iso7064", "luhn", "verhoeff"};

bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsCapital(char c) { return c >= 'A' && c <= 'Z'; }
int Number(char c) { return c - '0'; }
char Digit(int number) { return static_cast<char>('0' + number); }

char Iso7064(std::string_view digits) {
  int product = 10;
  for (const char c : digits) {
    int sum = (product + Number(c)) % 10;
    if (sum == 0) sum = 10;
    product = sum * 2 % 11;
  }
  return Digit((11 - product) % 10);
}

char Luhn(std::string_view digits) {
  int sum = 0;
  bool twice = true;  // the digit next to the check digit counts twice
  for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit, twice = !twice) {
    const int value = Number(*digit) * (twice ? 2 : 1);
    sum += value > 9 ? value - 9 : value;
  }
  return Digit((10 - sum % 10) % 10);
}

char Verhoeff(std::string_view digits) {
  // The dihedral group D5, as Verhoeff's table d(i, j), and powers of his permutation (1 5 7 6 2 8 3 0 9 4).
  const auto product = [](int a, int b) {
    if (a < 5) return b < 5 ? (a + b) % 5 : 5 + (a + b - 5) % 5;
    return b < 5 ? 5 + (a - 5 - b + 5) % 5 : (a - b + 5) % 5;
  };
  constexpr std::array<int, 10> kPermutation = {1, 5, 7, 6, 2, 8, 3, 0, 9, 4};
  constexpr std::array<int, 10> kInverse = {0, 4, 3, 2, 1, 5, 6, 7, 8, 9};
  int check = 0;
  int place = 1;  // place 0 is the check digit itself
  for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit, ++place) {
    int value = Number(*digit);
    for (int times = 0; times < place % 8; ++times) value = kPermutation[static_cast<std::size_t>(value)];
    check = product(check, value);
  }
  return Digit(kInverse[static_cast<std::size_t>(check)]);
}

bool HasCheckDigit(std::string_view pattern) { return pattern.ends_with('C'); }

/// True if `text` fits; `digits` is then what the check digit covers.
bool Fits(std::string_view text, std::string_view pattern, std::string& digits) {
  if (text.size() != pattern.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char wanted = pattern[i], given = text[i];
    if (wanted == '#' && IsDigit(given)) {
      digits += given;
    } else if (wanted == '?' && IsCapital(given)) {
      digits += std::to_string(10 + (given - 'A'));
    } else if (wanted == '#' || wanted == '?' || wanted != given) {
      return false;
    }
  }
  return true;
}

}  // namespace

Result<char> CheckDigitOf(std::string_view digits, std::string_view method) {
  if (!std::all_of(digits.begin(), digits.end(), IsDigit)) {
    return Fail(ErrorCode::kUsage, "a check digit is computed from digits only");
  }
  if (method == "iso7064") return Iso7064(digits);
  if (method == "luhn") return Luhn(digits);
  if (method == "verhoeff") return Verhoeff(digits);
  return Fail(ErrorCode::kUsage, "a check digit is iso7064, luhn or verhoeff, not '" + std::string(method) + "'");
}

Status CheckPattern(std::string_view pattern, std::string_view method) {
  if (pattern.empty() && method.empty()) return {};
  const bool signs = std::all_of(pattern.begin(), pattern.end(), [](char c) {
    return IsDigit(c) || IsCapital(c) || (c >= 'a' && c <= 'z') || c == '#' || c == '?' || c == '-' || c == '_' ||
           c == '.';
  });
  if (!signs || pattern.size() > kLongest || pattern.find_first_of("#?") == std::string_view::npos) {
    return Fail(ErrorCode::kUsage,
                "--subject-pattern has 1 to 32 of: # (a digit), ? (a capital letter), letters, digits, '-', '_', '.', "
                "and C at its end for a check digit; at least one # or ?; for example S###C");
  }
  if (HasCheckDigit(pattern) != !method.empty()) {
    return Fail(ErrorCode::kUsage, "a pattern with C at its end has a check digit (--check-digit), and no other has");
  }
  if (!method.empty() && std::find(kMethods.begin(), kMethods.end(), method) == kMethods.end()) {
    return Fail(ErrorCode::kUsage, "--check-digit is iso7064, luhn or verhoeff");
  }
  return {};
}

Status CheckPseudonym(std::string_view pseudonym, std::string_view pattern, std::string_view method) {
  if (pattern.empty()) return {};
  const std::string name(pseudonym.substr(0, 40));
  const std::string expected =
      " does not fit this study's pattern " + std::string(pattern) + " (# a digit, ? a capital letter";
  std::string digits;
  if (method.empty()) {
    if (Fits(pseudonym, pattern, digits)) return {};
    return Fail(ErrorCode::kUsage, name + expected + "); check it");
  }
  const std::string_view body = pattern.substr(0, pattern.size() - 1);
  if (Fits(pseudonym, body, digits)) {
    const auto digit = CheckDigitOf(digits, method);
    if (!digit) return Fail(digit.error());
    return Fail(ErrorCode::kUsage, name + " lacks its check digit; if it is a new pseudonym, it is " + name + *digit);
  }
  digits.clear();
  if (pseudonym.size() != pattern.size() || !IsDigit(pseudonym.back()) ||
      !Fits(pseudonym.substr(0, body.size()), body, digits)) {
    return Fail(ErrorCode::kUsage, name + expected + ", C the check digit); check it");
  }
  const auto digit = CheckDigitOf(digits, method);
  if (!digit) return Fail(digit.error());
  if (*digit == pseudonym.back()) return {};
  return Fail(ErrorCode::kUsage, "the check digit of " + name +
                                     " is wrong, so one of its signs is; compare it with the subject's document");
}

}  // namespace striae::store
