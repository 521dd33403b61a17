# shellcheck shell=bash
# Pictures of the page: compared with kept ones, and for show. Sourced by ./dev.

command_gallery() {
  if wants_help "$@"; then
    cat <<'TEXT'
usage: ./dev gallery [pictures] [--scenes A,B] [--lights A,B] [--qualities low,high] [--update]
       ./dev gallery readme|class|animation|tour|all [--qualities low|high]

pictures   one of every shipped scene as it is seen first, at a fixed tick, at low and high quality (the harbor in every light),
           into build/gallery; compares each with the one in tests/browser/gallery/kept, and makes a contact
           sheet (index.html, contact_sheet.png). --update keeps the new ones. Fails when one differs.
readme     web-client/screenshots/SCENE.webp, the pictures in the README
class      web-client/screenshots/class_*.webp, the pictures in docs/class.md
animation  web-client/screenshots/harbor.webp, the animated picture of the README
tour       build/gallery/tour.mp4, 20 s of several scenes and lights
all        all of these

Animation and tour are of high quality unless --qualities low is given. Without a GPU, pictures take minutes, the tour at high
quality most of an hour. Animation and tour continue where they were interrupted.
TEXT
    return
  fi
  local part="${1:-pictures}"
  [[ "$part" == --* ]] && part=pictures
  case "$part" in
    pictures | readme | class | animation | tour | all) ;;
    *) fail 2 "gallery does not know '$part'; see ./dev gallery --help" ;;
  esac
  local groups=(server driver browser)
  [[ "$part" == pictures || "$part" == class ]] || groups+=(video)
  need_packages "${groups[@]}"
  lock_build
  need_web
  build_server release spindrift
  build_web
  npm_install tests/browser browser
  npm_install tests/wire wire
  unlock_build
  env "SPINDRIFT_BINARY=$(binary_of release)" node tests/browser/gallery/main.mjs "$@"
}
