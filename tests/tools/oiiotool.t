# SPDX-License-Identifier: GPL-3.0-or-later
# What OpenImageIO writes of a stack again has the seals of the stack, and only if its values are the same.
. "$VAM_SOURCE/tests/tools/testlib.sh"
command -v oiiotool >/dev/null || { echo '1..0 # SKIP no oiiotool; apt-get install openimageio-tools'; exit 77; }

box 6 6 3 >a.off
vam-slice a.off --voxel 0.3 -o part.vdb
vam-sinogram part.vdb --half -o sino.exr
sealed() { vam-check "$1" | sed -n '1s/.*, sealed //p'; }
compression() {  # compression FILE: of all its images
  oiiotool --info -v "$1" | sed -n 's/ *compression: "\(.*\)"/\1/p' | sort -u
}
is 'the stack is sealed' "$(sealed sino.exr | grep -c '^[0-9a-f]\{16\}$')" 1
# DWAA and DWAB are of three channels and more: of one, oiiotool makes ZIP (tests/lib/io/seal_test.cpp has DWAA).
for asked in none rle zip zips piz pxr24 b44 b44a dwaa dwab; do
  case $asked in dwaa | dwab) written=zip ;; *) written=$asked ;; esac
  rm -f again.exr
  ok "oiiotool writes $asked" oiiotool sino.exr --compression $asked -o again.exr
  is "as $written" "$(compression again.exr)" $written
  case $written in
    b44 | b44a) fails 65 'again.exr: image 0 changed after it was written' vam-check again.exr
      fails 65 'again.exr: image 0 changed after it was written' vam-resample again.exr -o frames.exr ;;
    *) is "$asked keeps the seal" "$(sealed again.exr)" "$(sealed sino.exr)" ;;
  esac
done
vam-sinogram part.vdb -o float.exr
oiiotool float.exr -d half -o half.exr
fails 65 'half.exr: image 0 changed after it was written' vam-check half.exr
oiiotool -a float.exr --mulc 1.000001 -o scaled.exr
fails 65 'scaled.exr: image [0-9]* changed after it was written' vam-check scaled.exr

# Images of two stacks of one geometry: each is as it was written, the stack is not.
vam-slice a.off --voxel 0.30 -o second.vdb
vam-sinogram second.vdb -o other.exr
last=$(($(oiiotool -a --info -v float.exr | grep -c 'vam:index') - 1))
set -- float.exr --subimage 0
for i in $(seq 1 "$last"); do set -- "$@" other.exr --subimage "$i" --siappend; done
ok 'oiiotool mixes two stacks' oiiotool "$@" -o mixed.exr
fails 65 'mixed.exr: image 1 has another vam:history than image 0' vam-check mixed.exr

done_testing
