(* kickdrift verdict --lambda1 9/2 --lambda2 153/8 --h1 1 --h2 4/3 --certificate coexistence_minus.v *)
From Coq Require Import Reals QArith.
From Kickdrift Require Import Vocabulary Certificate.

(** kind, p, q with h2/h1 = p/q, then h1, lambda1, h2, lambda2. *)
Theorem kickdrift_verdict :
  verdict (Coexistence Minus) 4 3 (1 / 1) (9 / 2) (4 / 3) (153 / 8).
Proof. certify (1 # 1) (9 # 2) (4 # 3) (153 # 8). Qed.
Print Assumptions kickdrift_verdict.
