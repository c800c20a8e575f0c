// See killed_calls.cpp.
#pragma once

/// Calls that change a file before the kill; negative: none comes.
extern "C" long striae_test_calls_left;
