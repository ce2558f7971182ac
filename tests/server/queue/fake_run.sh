#!/bin/bash
# Stands in for `toile drape`: does what the scene's "name" says. Called as: fake_run.sh drape SCENE --out DIR …
set -u
if [[ $1 == render ]]; then # --job DIR --view V --overlay O --out FILE
  [[ $(cat "$3/drape.state") == state ]] && echo "picture $5 $7" >"$9"
  exit
fi
scene=$(cat "$2")
out=$4
tell() { echo "$1" >&3; }
say() { [[ $scene == *"\"$1\""* ]]; }
write_results() {
  echo '{"status":"'"$1"'"}' >"$out/report.json"
  echo 'v 0 0 0' >"$out/mesh.obj"
  echo 'state' >"$out/drape.state"
  echo 'secret' >"$out/unknown.txt"
  ln -s /etc/passwd "$out/preview-link.png"
}

if say crash; then echo "out of cheese" >&2; kill -SEGV $$; fi
if say silent-success; then exit 0; fi
if say hang; then tell '{"progress":{"stage":"drape","fraction":0.25}}'; sleep 60 & wait; fi
if say stubborn; then trap '' TERM; tell '{"progress":{"stage":"drape","fraction":0.25}}'; while :; do sleep 0.05; done; fi
if say bad-input; then
  tell '{"problem":{"type":"about:blank","title":"Bad input","status":422,"errors":[{"pointer":"/garments/0","code":"open_panel_loop","detail":"Open."}]}}'
  exit 2
fi
if say not-converged; then write_results not_converged; exit 3; fi
if say babble; then head -c 3000000 /dev/zero | tr '\0' x >&3; echo >&3; fi
if say assets; then cp assets/* "$out/mesh.glb"; fi
if say limits; then ulimit -v >"$out/mesh.glb"; fi
tell '{"progress":{"stage":"assemble","fraction":0.5}}'
tell 'not json {{{'
write_results converged
exit 0
