# SPDX-License-Identifier: BSD-3-Clause
"""How figures are written in pages: how many digits, and which way bounds are rounded."""
import math
import re


def short(value, digits=2):
    """As many digits, all of them where it is larger: 0.50, 35, 569, 5.6e-5."""
    if abs(value) < 1e-2:
        return re.sub(r"e-0?", "e-", "%.*e" % (digits - 1, value))
    return "%.0f" % value if abs(value) >= 10 ** digits - 0.5 else ("%#.*g" % (digits, value)).rstrip(".")


def outwards(value, side, unit):
    """The next multiple of a unit below (-1) or above (1)."""
    count = value / unit
    whole = round(count)  # it is one, but for rounding
    return unit * (whole if abs(count - whole) < 1e-9 * max(1.0, abs(count)) else math.floor(count) if side < 0 else math.ceil(count))


def bound(value, side, digits=2):
    """Rounded down (-1) or up (1) to as many digits."""
    return short(outwards(value, side, 10.0 ** (math.floor(math.log10(abs(value))) - digits + 1)), digits) if value else "0"


def within(value, digits=2):
    """An upper bound."""
    return bound(value, 1, digits)


def fixed(value, decimals=0):
    """So many decimals, and spaces where there are ten thousands."""
    text = "%.*f" % (decimals, value)
    return "{:,}".format(int(text)).replace(",", " ") if decimals == 0 and abs(value) >= 1e4 else text
