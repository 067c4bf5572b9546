# Stands in for a Tcl OpenSees where it is not installed: uniaxial materials that are elastic, perfectly plastic bars up to a strain of 1.
#
#   tclsh opensees.tcl SERVER --listen ADDRESS

array set plastic {}
array set strains {}

proc uniaxialMaterial {kind tag args} {
  if {$kind ne "Bar"} {
    error "$kind is unknown"
  }
  set ::plastic($tag) 0.0
  set ::strains($tag) 0.0
}
proc invoke {what tag script} {
  set ::current $tag
  return [uplevel 1 $script]
}
proc strain {value} {
  if {$value > 1} {
    error "too far"
  }
  set ::strains($::current) $value
}
proc stress {} {
  return [expr {min(max(2e8 * ($::strains($::current) - $::plastic($::current)), -2e5), 2e5)}]
}
proc tangent {} {
  return 2e8
}
proc commit {} {
  set ::plastic($::current) [expr {$::strains($::current) - [stress] / 2e8}]
}
proc wipe {} {
  array unset ::plastic
  array unset ::strains
}
proc model {args} {}
proc version {} {
  return stand-in
}
proc logFile {args} {}

set script [lindex $argv 0]
set argv [lrange $argv 1 end]
source $script
