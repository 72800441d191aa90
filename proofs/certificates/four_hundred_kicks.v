(* kickdrift verdict --lambda1 10 --lambda2 2/5 --h1 149/1000 --h2 251/1000 --certificate four_hundred_kicks.v *)
From Coq Require Import Reals QArith.
From Kickdrift Require Import Vocabulary Certificate.

(** kind, p, q with h2/h1 = p/q, then h1, lambda1, h2, lambda2. *)
Theorem kickdrift_verdict :
  verdict Elliptic 251 149 (149 / 1000) (10 / 1) (251 / 1000) (2 / 5).
Proof. certify (149 # 1000) (10 # 1) (251 # 1000) (2 # 5). Qed.
Print Assumptions kickdrift_verdict.
