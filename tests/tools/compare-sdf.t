# SPDX-License-Identifier: GPL-3.0-or-later
# vam-sdf against MeshLab, CloudCompare and Open3D on one pair of meshes: those that are installed. Without any of them
# the test is skipped, aloud.
"$VAM_SOURCE/scripts/compare-sdf"
