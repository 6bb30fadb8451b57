# SPDX-License-Identifier: MIT
# Warnings of our own targets (tests, examples, bench, the headers alone); never of a user's.
set(tunica_warnings -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror)
