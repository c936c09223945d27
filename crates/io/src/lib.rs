//! Point clouds and meshes in (PCD, PLY, XYZ, STL, OBJ), coloured PLY out.
