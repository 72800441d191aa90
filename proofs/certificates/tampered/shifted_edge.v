(* kickdrift tongues --ratio 7/3 --rho 1/25 --m 4 --certificate shifted_edge.v *)
From Coq Require Import Reals QArith.
From Kickdrift Require Import Vocabulary EdgeCertificate.

(** entry, p, q, rho, and the ends of an interval of s = h1^2 lambda1 that holds a zero of the entry. *)
Theorem kickdrift_lower :
  edge C 7 3 (1 / 25) (5199786023612 / 2199023255552) (5199786023613 / 2199023255552).
Proof. certify_edge (1 # 25) (5199786023612 # 2199023255552) (5199786023613 # 2199023255552). Qed.
Print Assumptions kickdrift_lower.
Theorem kickdrift_upper :
  edge B 7 3 (1 / 25) (5417988088821205 / 2251799813685248) (677248511102651 / 281474976710656).
Proof. certify_edge (1 # 25) (5417988088821205 # 2251799813685248) (677248511102651 # 281474976710656). Qed.
Print Assumptions kickdrift_upper.
