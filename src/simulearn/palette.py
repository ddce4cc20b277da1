"""Colours that pictures, thumbnails and pages share.

Top and bottom actuators have the vermillion and blue of Okabe and Ito's palette, which people with
any common colour blindness tell apart. What is not actuated is grey, the darker the more it binds;
the brim, which is cut off, is light brown. What prints of one design fill is purple.
"""

TOP, BOTTOM = "#d55e00", "#0072b2"
BAND = "#8e3b74"
# Of beads by role; an active bead has the colour of its half.
BEADS = {
    "skirt": "#b7b7b7",
    "brim": "#dccba6",
    "shell": "#4a4a4a",
    "passive": "#cfcfcf",
    "joint": "#8f8f8f",
}
