"""Formats of files of motions, in words: for messages and help, without any reader."""

#: What files of motions may be.
FORMATS = (
    "PEER AT2, ESM ASC, COSMOS V1 and V2, CSMIP V1 and V2, SMC, GeoNet V1A and V2A, AFAD, columns "
    "of text (CSV, tabs, spaces; decimal comma or point), HDF5 with arrays acc and time; with the "
    "extra records K-NET, KiK-net, SAC, miniSEED, GSE2"
)
