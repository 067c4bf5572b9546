# Offers the uniaxial materials of an unmodified Tcl OpenSees to Breccia over TCP, with trial and commit apart, so that solvers may
# iterate. The protocol stands in docs/material-server.md. Needs an OpenSees whose command `invoke` reaches a material (the package
# `opensees` of the Python index; scripts/opensees.sh):
#
#   OpenSees opensees_server.tcl --listen tcp://127.0.0.1:4712 [--secret-file FILE] [--once]

# OpenSees deletes its many commands and makes them again with each model, even those of its names that stand in a namespace: none here is called as one of its own.
namespace eval server {
  variable MAGIC BRMS
  # Materials whose liquefaction is a stage that pore pressures of elements drive (updateMaterialStage of OpenSees): without them they would not liquefy.
  variable UNDRIVEN {PyLiq1 TzLiq1 QzLiq1}
  variable VERSION 1
  variable MOST_PAYLOAD [expr {1 << 28}]
  variable MOST_POINTS 1000000
  variable OPERATIONS
  array set OPERATIONS {1 hello 2 probe 3 create 4 attach 5 trial 6 commit 7 revert 8 save 9 restore 10 statistics 11 bye 12 laws}
  variable ERROR 127
  # What is held (`tried`: of each point, 1 if it has a trial that could be committed), and the client that is served.
  variable held
  array set held {session 0 count 0 tried {} commits 0 seconds 0.0 evaluations 0 probe 2000000000}
  variable client
  array set client {channel {} last -1 frame {} leaving 0 bytes {} timer {}}
  # Connections that have not greeted yet, in the order in which they came: of each the timer that ends it and what has come.
  variable guests {}
  variable MOST_GUESTS 8
  variable GREETING_SECONDS 5
  variable MOST_GREETING 4096
  variable FRAME_SECONDS 60
  # Words that clients must know; whether to end with the first client; a file with what OpenSees prints.
  variable secret {}
  variable once 0
  variable log {}
}

proc server::refuse {words} {
  return -code error -errorcode REFUSAL $words
}

# ---- materials ----

# The kind and arguments of 'uniaxialMaterial KIND $tag ...'. They are handed over word by word and never evaluated. A kind that
# OpenSees does not know it looks for in shared libraries: hence no paths.
proc server::parseCommand {lines} {
  set words [regexp -all -inline {\S+} [dict get $lines command]]
  lassign $words command kind tag
  if {$command eq "nDMaterial"} {
    refuse "a Tcl OpenSees offers no way to drive an nDMaterial from outside: use breccia-opensees"
  }
  if {$command ne "uniaxialMaterial" || $tag ne "\$tag" || ![regexp {^[A-Za-z0-9_]+$} $kind]} {
    refuse "a command is 'uniaxialMaterial KIND \$tag ...'"
  }
  variable UNDRIVEN
  if {$kind in $UNDRIVEN} {
    refuse "$kind takes pore pressures from elements of OpenSees, which a server has none of, and would not liquefy: take PySimple1, TzSimple1 or QzSimple1"
  }
  if {[dict exists $lines stage]} {
    refuse "$kind has no stages: leave 'stage' out"
  }
  set arguments {}
  foreach word [lrange $words 3 end] {
    if {$word eq "\$length"} {
      if {![dict exists $lines length]} {
        refuse "the command asks for \$length, and the client told none"
      }
      set word [dict get $lines length]
    }
    lappend arguments $word
  }
  return [list $kind $arguments]
}

proc server::makePoint {command tag} {
  lassign $command kind arguments
  uniaxialMaterial $kind $tag {*}$arguments
}

proc server::whatOpenSeesSaid {start} {
  variable log
  seek $log $start
  return [join [regexp -all -inline {\S+} [read $log]] " "]
}

# The tangent of what the command makes, before any strain.
proc server::probe {command} {
  variable log
  variable held
  if {!$held(count)} {
    wipe
  }
  model basic -ndm 3 -ndf 3
  set tag [incr held(probe)]
  seek $log 0 end
  set start [tell $log]
  if {[catch {
    makePoint $command $tag
    set tangent [invoke UniaxialMaterial $tag tangent]
  } problem]} {
    set said [whatOpenSeesSaid $start]
    refuse "OpenSees refuses '[lindex $command 0]': [expr {$said ne "" ? "it said: $said" : $problem}]"
  }
  if {!($tangent > 0)} {
    refuse "OpenSees tells no stiffness of '[lindex $command 0]' ($tangent)"
  }
  return [describe $tangent]
}

# Moduli as of a material with Poisson ratio 1/4, whose Young modulus is the tangent.
proc server::describe {tangent} {
  return "components: 1\nbulk: [expr {$tangent / 1.5}]\nshear: [expr {$tangent / 2.5}]\nstate: 0\niterates: 1\nsaves: 0\n"
}

proc server::forgetTrials {} {
  variable held
  set held(tried) [lrepeat $held(count) 0]
}

# Notes whether points have a trial.
proc server::noteTrials {first count tried} {
  variable held
  if {$count} {
    set held(tried) [lreplace $held(tried) $first [expr {$first + $count - 1}] {*}[lrepeat $count $tried]]
  }
}

# Makes the last trial of each point its state; a point that has none keeps its state.
proc server::commitPoints {} {
  variable held
  if {1 ni $held(tried)} {
    refuse "there is no trial to commit"
  }
  set tag 0
  foreach tried $held(tried) {
    incr tag
    if {$tried} {
      invoke UniaxialMaterial $tag commit
    }
  }
  forgetTrials
  incr held(commits)
}

# ---- what a client can ask: each gives the text or bytes of the answer ----

proc server::parseLines {payload} {
  set lines {}
  foreach line [split [encoding convertfrom utf-8 $payload] "\n"] {
    set colon [string first : $line]
    if {$colon > 0} {
      dict set lines [string trim [string range $line 0 $colon-1]] [string trim [string range $line $colon+1 end]]
    }
  }
  if {![dict exists $lines command]} {
    dict set lines command {}
  }
  return $lines
}

proc server::sameSecret {given} {
  variable secret
  set different [expr {[string length $given] != [string length $secret]}]
  foreach a [split $given {}] b [split $secret {}] {
    set different [expr {$different | ($a ne $b)}]
  }
  return [expr {!$different}]
}

proc server::checkSecret {payload} {
  variable secret
  set lines [parseLines $payload]
  if {$secret ne "" && !([dict exists $lines secret] && [sameSecret [dict get $lines secret]])} {
    refuse "the secret is wrong"
  }
}

proc server::obey_hello {flags count payload} {
  variable held
  variable client
  set client(leaving) 1
  checkSecret $payload
  set client(leaving) 0
  return "program: OpenSees [::version], Tcl [info patchlevel]\nsession: $held(session)\npoints: $held(count)\ncommits: $held(commits)\n"
}

proc server::obey_probe {flags count payload} {
  return [probe [parseCommand [parseLines $payload]]]
}

proc server::obey_create {flags count payload} {
  variable MOST_POINTS
  variable held
  if {$count > $MOST_POINTS} {
    refuse "$count points are more than a server takes ($MOST_POINTS)"
  }
  set command [parseCommand [parseLines $payload]]
  array set held {session 0 count 0 tried {} commits 0 seconds 0.0 evaluations 0}
  set answer [probe $command]
  for {set tag 1} {$tag <= $count} {incr tag} {
    makePoint $command $tag
  }
  set held(count) $count
  forgetTrials
  set held(session) [expr {int(rand() * 0x7fffffff) + 1}]
  return $answer
}

proc server::obey_attach {flags count payload} {}

proc server::obey_trial {flags count payload} {
  variable held
  if {[string length $payload] != 8 + 8 * $count} {
    refuse "$count strains were announced, and [string length $payload] bytes came"
  }
  binary scan $payload iuiuq* first - strains
  if {$first + $count > $held(count)} {
    refuse "points $first to [expr {$first + $count - 1}] were asked for; there are $held(count)"
  }
  set start [clock microseconds]
  if {$flags & 1} {
    commitPoints
  }
  noteTrials $first $count 0 ;# one that fails leaves the points without
  set tag $first
  set stresses {}
  set tangents {}
  if {[catch {
    if {$flags & 2} {
      foreach strain $strains {
        lassign [invoke UniaxialMaterial [incr tag] {strain $strain; list [stress] [tangent]}] stress tangent
        lappend stresses $stress
        lappend tangents $tangent
      }
    } else {
      foreach strain $strains {
        lappend stresses [invoke UniaxialMaterial [incr tag] {strain $strain; stress}]
      }
    }
    set answer [binary format q*q* $stresses $tangents]
  } problem]} {
    return -code error -errorcode [list POINT [expr {$tag - $first - 1}]] "OpenSees cannot follow the strain of a point: $problem"
  }
  noteTrials $first $count 1
  set held(seconds) [expr {$held(seconds) + ([clock microseconds] - $start) * 1e-6}]
  incr held(evaluations) $count
  return $answer
}

proc server::obey_commit {flags count payload} {
  commitPoints
}

proc server::obey_revert {flags count payload} {
  forgetTrials
  return
}

proc server::obey_save {flags count payload} {
  refuse "OpenSees can neither save nor restore the state of a material"
}

proc server::obey_restore {flags count payload} {
  obey_save $flags $count $payload
}

proc server::obey_statistics {flags count payload} {
  variable held
  return "seconds: $held(seconds)\nevaluations: $held(evaluations)\ncommits: $held(commits)\n"
}

proc server::obey_laws {flags count payload} {
  refuse "a Tcl OpenSees does not tell which materials it has"
}

proc server::obey_bye {flags count payload} {
  variable client
  set client(leaving) 1
  return
}

# ---- frames ----

proc server::seal {operation sequence flags count body} {
  variable held
  variable MAGIC
  variable VERSION
  set head [binary format a4ssiiiii $MAGIC $VERSION $operation $sequence $flags $count [string length $body] $held(session)]
  return "$head[binary format i [zlib crc32 $body [zlib crc32 $head]]]$body"
}

proc server::checkVersion {version} {
  variable VERSION
  if {$version != $VERSION} {
    refuse "this server speaks version $VERSION of the protocol, the client version $version"
  }
}

proc server::answer {version operation sequence flags count session payload} {
  variable ERROR
  variable held
  variable client
  variable OPERATIONS
  if {$sequence == $client(last) && $operation != 1} {
    return $client(frame)
  }
  if {[catch {
    checkVersion $version
    if {![info exists OPERATIONS($operation)]} {
      refuse "operation $operation is unknown"
    }
    set name $OPERATIONS($operation)
    if {$operation >= 4 && $operation <= 9 && (!$held(session) || $session != $held(session))} {
      refuse "session $session is not held here"
    }
    set body [obey_$name $flags $count $payload]
    set frame [seal [expr {$operation | 128}] $sequence 0 [expr {$name eq "trial" ? $count : 0}] $body]
  } words options]} {
    set code [dict get $options -errorcode]
    set failed [expr {[lindex $code 0] eq "POINT"}]
    set words [encoding convertto utf-8 [string range $words 0 2000]]
    set frame [seal $ERROR $sequence $failed [expr {$failed ? [lindex $code 1] : 0}] $words]
  }
  set client(last) $sequence
  set client(frame) $frame
  return $frame
}

# ---- the line to the client ----

proc server::closeLine {channel} {
  variable done
  variable once
  variable client
  catch {close $channel}
  if {$channel eq $client(channel)} {
    after cancel $client(timer)
    set client(channel) {}
    if {$once} {
      set done 1
    }
  }
}

proc server::say {channel frame} {
  if {[catch {
    puts -nonewline $channel $frame
    flush $channel
  }]} {
    closeLine $channel
  }
}

# Takes the frame in front of what has come, whose payload has at most so many bytes: what `answer` is called with, or nothing while it is not whole.
proc server::takeFrame {name most} {
  variable MAGIC
  upvar 1 $name bytes
  if {[string length $bytes] < 32} {
    return {}
  }
  binary scan $bytes a4susuiuiuiuiuiuiu magic version operation sequence flags count length session checksum
  if {$magic ne $MAGIC} {
    refuse "what came is no frame of this protocol"
  }
  if {$length > $most} {
    refuse "a frame of $length bytes was announced; the most is $most"
  }
  if {[string length $bytes] < 32 + $length} {
    return {}
  }
  set payload [string range $bytes 32 [expr {31 + $length}]]
  if {[zlib crc32 $payload [zlib crc32 [string range $bytes 0 27]]] != $checksum} {
    refuse "a frame came damaged (its checksum does not hold)"
  }
  set bytes [string range $bytes [expr {32 + $length}] end]
  return [list $version $operation $sequence $flags $count $session $payload]
}

# Takes what has come from the client, and answers each frame that is whole.
proc server::hear {channel} {
  variable ERROR
  variable MOST_PAYLOAD
  variable FRAME_SECONDS
  variable client
  if {[catch {append client(bytes) [read $channel]}] || [eof $channel]} {
    closeLine $channel
    return
  }
  after cancel $client(timer)
  while {$client(channel) eq $channel} {
    if {[catch {takeFrame client(bytes) $MOST_PAYLOAD} frame]} {
      say $channel [seal $ERROR 0 0 0 $frame]
      closeLine $channel
    } elseif {[llength $frame]} {
      say $channel [answer {*}$frame]
      if {$client(leaving)} {
        closeLine $channel
      }
    } elseif {$client(bytes) ne ""} {
      set client(timer) [after [expr {1000 * $FRAME_SECONDS}] [list server::closeLine $channel]]
      return
    } else {
      return
    }
  }
}

# ---- connections that have not greeted yet: none is waited for ----

proc server::forgetGuest {channel} {
  variable guests
  after cancel [lindex [dict get $guests $channel] 0]
  dict unset guests $channel
}

proc server::letGo {channel} {
  forgetGuest $channel
  catch {close $channel}
}

# Tells a guest why it is not served. What else it sends is read and dropped, or closing would take the words away again.
proc server::dismiss {channel sequence words} {
  variable ERROR
  if {[catch {
    puts -nonewline $channel [seal $ERROR $sequence 0 0 [encoding convertto utf-8 $words]]
    flush $channel
    close $channel write
  }]} {
    letGo $channel
    return
  }
  fileevent $channel readable [list server::drain $channel]
}

proc server::drain {channel} {
  if {[catch {read $channel 4096}] || [eof $channel]} {
    letGo $channel
  }
}

# Refuses a first frame that does not greet as it should.
proc server::checkGreeting {version operation sequence flags count session payload} {
  variable client
  checkVersion $version
  if {$operation != 1} {
    refuse "a client says HELLO first"
  }
  checkSecret $payload
  if {$client(channel) ne ""} {
    hear $client(channel) ;# if it has just left, whoever greets is the next one
  }
  if {$client(channel) ne ""} {
    refuse "the server is busy with another client"
  }
}

# Takes what has come from a guest; one that greets is the client from then on.
proc server::hearGuest {channel} {
  variable guests
  variable client
  variable MOST_GREETING
  lassign [dict get $guests $channel] timer bytes
  if {[catch {append bytes [read $channel [expr {32 + $MOST_GREETING - [string length $bytes]}]]}] || [eof $channel]} {
    letGo $channel
    return
  }
  dict set guests $channel [list $timer $bytes]
  set sequence 0
  if {[catch {
    set frame [takeFrame bytes $MOST_GREETING]
    if {[llength $frame]} {
      set sequence [lindex $frame 2]
      checkGreeting {*}$frame
    }
  } words]} {
    dismiss $channel $sequence $words
    return
  }
  if {[llength $frame]} {
    forgetGuest $channel
    array set client [list channel $channel last -1 frame {} leaving 0 bytes $bytes timer {}]
    fileevent $channel readable [list server::hear $channel]
    say $channel [answer {*}$frame]
  }
}

proc server::meet {channel host port} {
  variable guests
  variable MOST_GUESTS
  variable GREETING_SECONDS
  fconfigure $channel -translation binary -blocking 0 -buffersize 1000000
  if {[dict size $guests] == $MOST_GUESTS} {
    letGo [lindex [dict keys $guests] 0] ;# the one that has been here longest
  }
  dict set guests $channel [list [after [expr {1000 * $GREETING_SECONDS}] [list server::letGo $channel]] {}]
  fileevent $channel readable [list server::hearGuest $channel]
}

# ---- the program ----

proc server::leave {words} {
  ::chan puts stderr "breccia-opensees-tcl: $words"
  exit 2
}

# The options, by their names. Words up to the next option belong together: OpenSees takes a path with a blank apart.
proc server::parseArguments {words} {
  set options {--listen {} --secret-file {} --once 0}
  set option {}
  foreach word $words {
    if {[string match --* $word] && ![dict exists $options $word] || $option eq "" && ![string match --* $word]} {
      leave "'$word' is unknown; there are --listen tcp://HOST:PORT, --secret-file FILE and --once"
    }
    if {[dict exists $options $word]} {
      set option $word
      dict set options $option [expr {$word eq "--once" ? 1 : {}}]
      set value {}
    } else {
      dict set options $option [join [lappend value $word] " "]
    }
  }
  return $options
}

proc server::readSecret {path} {
  if {[file exists $path] && ![file isfile $path]} { # a device or pipe may never end
    leave "$path: no secret can be read there: it is no file"
  }
  if {[catch {open $path} file]} {
    leave "--secret-file: $file"
  }
  set secret [string trim [gets $file]]
  close $file
  if {$secret eq ""} {
    leave "$path: no secret stands there"
  }
  return $secret
}

proc server::main {words} {
  variable secret
  variable once
  variable log
  variable done
  set options [parseArguments $words]
  set once [dict get $options --once]
  set address [dict get $options --listen]
  if {![regexp {^tcp://(\[[0-9a-fA-F:.]+\]|[^:]+):([0-9]+)$} $address - host port]} {
    leave "where to listen is told by --listen tcp://HOST:PORT"
  }
  if {[string length $port] > 5 || [scan $port %d] > 65535} {
    leave "$address: cannot be listened to: '$port' is no port: expected a number from 0 to 65535"
  }
  set host [string trim $host {[]}]
  if {"--secret-file" in $words} {
    set secret [readSecret [dict get $options --secret-file]]
  } elseif {$host ni {localhost ::1} && ![string match 127.* $host]} {
    leave "a server listens on this machine only, unless a secret guards it (--secret-file)"
  }
  if {[catch {model basic -ndm 3 -ndf 3}]} {
    leave "this is no OpenSees: run me as OpenSees opensees_server.tcl --listen tcp://127.0.0.1:4712"
  }
  if {[llength [info commands invoke]] == 0} {
    leave "this OpenSees cannot be asked for the stress of a material (it has no 'invoke'); the package 'opensees' of the Python index can"
  }
  set log [file tempfile name]
  logFile $name -noEcho
  file delete $name ;# both have it open
  if {[catch {socket -server server::meet -myaddr $host $port} listener]} {
    leave "$address: cannot be listened to: $listener"
  }
  expr {srand([clock microseconds] ^ ([pid] << 20))}
  lassign [fconfigure $listener -sockname] where - port
  chan puts stdout "listening at tcp://[expr {[string first : $where] < 0 ? $where : "\[$where\]"}]:$port"
  flush stdout
  vwait server::done
}

# The arguments begin after the name of this file, which some interpreters put among them.
server::main [lrange $argv [expr {[lindex $argv 0] eq [info script] || [string match *.tcl [lindex $argv 0]]}] end]
exit 0
